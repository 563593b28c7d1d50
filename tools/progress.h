// Progress of a long command: a bar on a terminal, plain lines elsewhere, JSON lines for machines.
#pragma once

#include <chrono>
#include <string>
#include <string_view>

#include "renderer/render.h"

namespace etendue {

enum class ProgressStyle { automatic, bar, lines, json, quiet };

/// Writes to standard error. At most ten updates a second (bar), or one every ten seconds (lines).
class Progress {
public:
    explicit Progress(ProgressStyle style);
    void update(const RenderProgress& progress);
    void finish(const RenderProgress& progress);

private:
    void write(const RenderProgress& progress, bool isLast);
    ProgressStyle style_;
    double lastSeconds_ = -1e9;
};

/// How far a lens fit is, on standard error: a bar on a terminal, elsewhere a line for each stage.
class FitBar {
public:
    FitBar();
    void update(double share, std::string_view stage);
    void clear() const;

private:
    bool isTerminal_;
    std::string stage_;
};

/// How far a list of jobs is, on standard error: a bar on a terminal, elsewhere a line for each
/// that is done.
class JobBar {
public:
    /// `secondsEach`: about what a job takes, for the time left until one is done.
    JobBar(std::size_t jobs, double secondsEach);
    /// `name`: of the job that is under way, `share` of it done.
    void update(const std::string& name, double share);
    void finishJob(const std::string& outcome);
    /// Those done before: they took no time.
    void skipJobs(std::size_t count);
    void clear() const;

private:
    double secondsLeft(double share) const;

    bool isTerminal_;
    std::size_t jobs_, done_ = 0, skipped_ = 0;
    double secondsEach_, lastSeconds_ = -1e9;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// To standard error, at once. If nobody can read it that is no reason to lose a render.
void say(const std::string& text);

/// "1:02:03", "2:03" or "4.2 s".
std::string formatDuration(double seconds);

}  // namespace etendue
