// Every model of Debian's assimp-testmodels and glmark2-data that loads is also rendered.
#include <doctest/doctest.h>

#include <numeric>

#include "tests/support/scenes.h"

using namespace etendue;

TEST_CASE("Render: every real model that loads gives a picture with light in it") {
    int rendered = 0;
    for (const char* folder : {"/usr/share/assimp/models", "/usr/share/glmark2/models"}) {
        std::error_code notInstalled;
        for (const auto& entry :
             std::filesystem::recursive_directory_iterator(folder, notInstalled)) {
            if (entry.path().extension() != ".obj") continue;
            CAPTURE(entry.path().string());
            try {
                const LoadedScene loaded =
                    loadScene(entry.path(), {{"film.width=24", "film.height=24"}, 1});
                const std::vector<float> pixels = renderPixels(loaded, 2, 1);
                CHECK(std::accumulate(pixels.begin(), pixels.end(), 0.0f) > 1.0f);
                ++rendered;
            } catch (const InputError& error) {
                // Which ones may be refused, and why, is tested beside the loader.
                CHECK(std::string(error.what()).find(entry.path().filename().string()) !=
                      std::string::npos);
            }
        }
    }
    if (rendered == 0) MESSAGE("assimp-testmodels and glmark2-data are not installed: skipped");
}
