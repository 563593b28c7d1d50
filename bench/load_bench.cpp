// Seconds and memory from an OBJ of a million triangles to a scene that can be traced.
#include <fmt/format.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <filesystem>

#include "renderer/parallel.h"
#include "renderer/scene_loader.h"

namespace etendue {
namespace {

/// A rolling grid of `side`² vertices with normals and texture coordinates.
void writeGrid(const std::filesystem::path& file, int side) {
    FILE* out = std::fopen(file.c_str(), "w");
    if (!out) throw std::runtime_error("cannot write " + file.string());
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            fmt::print(out, "v {:.3f} {:.3f} {:.3f}\nvt {:.4f} {:.4f}\nvn 0 1 0\n", x * 0.01,
                       (x * 7 + y * 13) % 17 * 0.001, y * 0.01, x / double(side), y / double(side));
    for (int y = 0; y + 1 < side; ++y)
        for (int x = 0; x + 1 < side; ++x) {
            const int a = y * side + x + 1, b = a + 1, c = a + side, d = c + 1;
            fmt::print(
                out,
                "f {0}/{0}/{0} {1}/{1}/{1} {2}/{2}/{2}\nf {2}/{2}/{2} {1}/{1}/{1} {3}/{3}/{3}\n", a,
                c, b, d);
        }
    std::fclose(out);
}

}  // namespace
}  // namespace etendue

int main() {
    using namespace etendue;
    const std::filesystem::path file =
        std::filesystem::temp_directory_path() / "etendue-load-bench.obj";
    writeGrid(file, 708);
    const auto start = std::chrono::steady_clock::now();
    const LoadedScene loaded = loadScene(file, {{}, hardwareThreads()});
    const double seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::filesystem::remove(file);
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    fmt::print("{} triangles loaded and built in {:.2f} s, {} MB of memory at most\n",
               loaded.scene->triangleCount(), seconds, usage.ru_maxrss / 1024);
}
