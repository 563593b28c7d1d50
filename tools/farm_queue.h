// Slurm's own commands.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace etendue {

/// MaxArraySize: elements of job arrays have lower numbers. Slurm's default where no controller can
/// be asked, 0 where the controller has switched arrays off.
std::uint32_t slurmArrayLimit();

/// Runs a shell's line that submits a job and gives the job's id. What sbatch says goes to standard
/// error; throws std::runtime_error if it fails.
std::string submit(const std::string& line);

/// Which of these jobs are queued or running, as squeue has it; empty if none is.
std::string queuedJobs(const std::vector<std::string>& ids);

}  // namespace etendue
