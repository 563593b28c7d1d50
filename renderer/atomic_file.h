// Files that are written whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>

namespace etendue {

/// Writes ".NAME.tmp-PID" in the folder of `file`, syncs it, renames it to `file` and syncs the
/// folder, so that whatever happens `file` is either the old one or the whole new one. A symbolic
/// link is written through to its destination; what is not a regular file (a pipe, /dev/stdout) is
/// written directly. A file that exists keeps its permissions, a new one gets 0666 less the umask.
///
/// Throws std::system_error, "FILE: cannot write: " and the system's reason, and then leaves no
/// temporary. Needs SIGXFSZ and SIGPIPE to be ignored if their conditions are to become such an
/// error. One writer per file at a time; temporaries of killed processes are not swept.
void writeFileAtomically(const std::filesystem::path& file, const void* data, std::size_t size);

}  // namespace etendue
