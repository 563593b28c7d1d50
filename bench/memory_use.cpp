// Memory that a render takes beside its scene: what its process has more at the most than it had
// with the scene loaded. Each in a process of its own.
#include <fmt/format.h>
#include <malloc.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <fstream>
#include <stdexcept>

#include "bench/bench_scene.h"

namespace etendue {
namespace {

/// A line of /proc/self/status, in bytes.
double statusBytes(const std::string& key) {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(key + ":")) return 1024.0 * std::stod(line.substr(key.size() + 1));
    throw std::runtime_error("no " + key + " in /proc/self/status");
}

double bytesOfRender(const std::filesystem::path& scene, const std::string& kind, int size,
                     std::uint32_t samples) {
    const LoadedScene loaded = loadForBench(scene, size, size);
    malloc_trim(0);
    std::ofstream("/proc/self/clear_refs") << 5 << std::flush;  // the most so far is forgotten
    const double before = statusBytes("VmRSS");
    renderForBench(loaded, kind, samples, 2);
    return statusBytes("VmHWM") - before;
}

double inChild(const std::filesystem::path& scene, const std::string& kind, int size,
               std::uint32_t samples) {
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    const pid_t child = fork();
    if (child < 0) throw std::runtime_error("no process");
    if (child == 0) {
        double bytes = -1.0;
        try {
            bytes = bytesOfRender(scene, kind, size, samples);
        } catch (const std::exception& error) {
            fmt::print(stderr, "{}\n", error.what());
        }
        const bool isWritten = write(ends[1], &bytes, sizeof bytes) == sizeof bytes;
        _exit(isWritten ? 0 : 1);
    }
    close(ends[1]);
    double bytes = -1.0;
    const bool isRead = read(ends[0], &bytes, sizeof bytes) == sizeof bytes;
    close(ends[0]);
    waitpid(child, nullptr, 0);
    if (!isRead || bytes < 0.0) throw std::runtime_error("the render whose memory counts failed");
    return bytes;
}

}  // namespace

void benchMemory(const std::filesystem::path& project, const std::string& wanted) {
    const std::string name = wanted.empty() ? "cornell-box" : wanted;
    const std::filesystem::path scene = project / "scenes" / name / "scene.toml";
    fmt::print("{}: MB beside the scene, two threads\n{:<8}", name, "");
    struct Run {
        int size;
        std::uint32_t samples;
    };
    constexpr Run runs[] = {{256, 1}, {512, 1}, {512, 4}, {512, 16}, {1024, 1}, {2048, 1}};
    for (const Run& run : runs)
        fmt::print("{:>14}", fmt::format("{}² × {}", run.size, run.samples));
    fmt::print("{:>22}\n", "bytes per pixel*");
    for (const char* kind : {"pt", "lt", "bdpt"}) {
        fmt::print("{:<8}", kind);
        std::vector<double> bytes;
        for (const Run& run : runs) {
            bytes.push_back(inChild(scene, kind, run.size, run.samples));
            fmt::print("{:>14.1f}", bytes.back() * 1e-6);
            std::fflush(stdout);
        }
        fmt::print("{:>22.1f}\n", bytes.back() / (2048.0 * 2048.0));
    }
    fmt::print("* of the largest, all that it takes\n");
}

}  // namespace etendue
