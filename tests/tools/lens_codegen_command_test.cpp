#include "tests/support/temporary_folder.h"
#include "tests/tools/command_outcome.h"

using namespace etendue;

TEST_CASE("Lens command: codegen writes a lens for other programs, to a file or to the terminal" *
          doctest::test_suite("slow")) {
    const TemporaryFolder folder;
    const std::string cache = "XDG_CACHE_HOME=" + folder.path().string();
    const std::string fit = "lens codegen double-gauss-100mm --terms 8 --degree 4 ";
    const std::string file = (folder / "lens.glsl").string();
    const Outcome glsl = run(fit + "--language glsl --name gauss -o " + file, cache);
    CHECK(glsl.code == 0);
    CHECK(contains(readFile(file), "GaussRay gaussTrace("));
    const Outcome header = run(fit + "--language c++", cache);
    CHECK(header.code == 0);
    CHECK(contains(header.output, "struct DoubleGauss100mm {"));
    CHECK(run(fit + "--language fortran", cache).code == 64);
    CHECK(run(fit + "--name --", cache).code == 64);
    CHECK(run(fit + "-o " + (folder / "none" / "lens.h").string(), cache).code == 66);
}
