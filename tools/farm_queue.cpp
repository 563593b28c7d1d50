#include "tools/farm_queue.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cstdio>
#include <stdexcept>

#include "tools/farm_scripts.h"

namespace etendue {

namespace {

struct Answer {
    std::string text;  // of standard output
    bool succeeded;
};

Answer answerTo(const std::string& line) {
    std::fflush(stdout);
    FILE* pipe = popen(line.c_str(), "re");
    if (!pipe) throw std::runtime_error(line + ": cannot be run");
    Answer answer{};
    std::array<char, 4096> buffer;
    while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
        answer.text.append(buffer.data(), n);
    answer.succeeded = pclose(pipe) == 0;
    return answer;
}

}  // namespace

std::uint32_t slurmArrayLimit() {
    constexpr std::uint32_t defaultLimit = 1001;
    const std::string config = answerTo("scontrol show config 2>/dev/null").text;
    const std::size_t key = config.find("MaxArraySize");
    const std::size_t value = config.find_first_of("0123456789", key);
    if (key == std::string::npos || value == std::string::npos) return defaultLimit;
    std::uint32_t limit = defaultLimit;
    std::from_chars(config.data() + value, config.data() + config.size(), limit);
    return limit;
}

std::string submit(const std::string& line) {
    const Answer answer = answerTo(line);
    // Where there are several clusters it is "ID;CLUSTER".
    std::string id = answer.text.substr(0, answer.text.find_first_of(";\n"));
    if (!answer.succeeded || id.empty()) throw std::runtime_error(line + ": failed");
    return id;
}

std::string queuedJobs(const std::vector<std::string>& ids) {
    std::string list;
    for (const std::string& id : ids) list += (list.empty() ? "" : ",") + id;
    if (list.empty()) return {};
    // It fails where it has forgotten the only job it is asked for.
    const std::string line = "squeue --noheader --jobs=" + shellQuoted(list) + " 2>/dev/null";
    return answerTo(line).text;
}

}  // namespace etendue
