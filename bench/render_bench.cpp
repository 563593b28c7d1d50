// What a render costs, beside what it cannot cost less than: the tables of docs/performance.md.
// Arguments: the project's folder; a part (embree, vertices, splats, memory), else all; a scene,
// else all.
#include <fmt/format.h>

#include <cstdio>
#include <exception>

#include "bench/bench_scene.h"

int main(int argc, char** argv) {
    const std::filesystem::path project = argc > 1 ? argv[1] : ".";
    const std::string part = argc > 2 ? argv[2] : "", scene = argc > 3 ? argv[3] : "";
    struct Part {
        const char* name;
        void (*run)(const std::filesystem::path&, const std::string&);
    };
    // Memory first: its processes are copies of this one, which must not have threads yet.
    const Part parts[] = {{"memory", etendue::benchMemory},
                          {"embree", etendue::benchEmbreeShare},
                          {"vertices", etendue::benchVertices},
                          {"splats", etendue::benchSplats}};
    try {
        for (const Part& p : parts) {
            if (!part.empty() && part != p.name) continue;
            fmt::print("\n{}\n", p.name);
            p.run(project, scene);
            std::fflush(stdout);
        }
    } catch (const std::exception& error) {
        fmt::print(stderr, "render_bench: {}\n", error.what());
        return 1;
    }
}
