// The command run as a user runs it.
#pragma once

#include <doctest/doctest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <string>

namespace etendue {

struct Outcome {
    int code;            // of one that a signal ended, 128 more than that, as a shell says it
    std::string output;  // both streams
};

/// A line of the shell.
inline Outcome shell(const std::string& line) {
    FILE* pipe = popen(("exec 2>&1; " + line).c_str(), "r");
    REQUIRE(pipe);
    Outcome outcome{};
    std::array<char, 4096> buffer;
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        outcome.output.append(buffer.data(), n);
    const int status = pclose(pipe);
    outcome.code = WIFSIGNALED(status) ? 128 + WTERMSIG(status) : WEXITSTATUS(status);
    return outcome;
}

/// `environment`: "NAME=value", or nothing.
inline Outcome run(const std::string& arguments, const std::string& environment = "") {
    return shell(environment + " " + ETENDUE_COMMAND + " " + arguments);
}

/// The command, killed by the call that `call` counts (tests/support/unkind_machine).
inline Outcome killAtCall(int call, const std::string& arguments) {
    return run(arguments,
               "LD_PRELOAD=" ETENDUE_UNKIND_MACHINE " UNKIND_KILL=" + std::to_string(call));
}

inline bool contains(const std::string& text, const std::string& fragment) {
    return text.find(fragment) != std::string::npos;
}

}  // namespace etendue
