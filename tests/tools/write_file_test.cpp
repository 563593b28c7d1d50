#include "tools/write_file.h"

#include <doctest/doctest.h>

#include "config/config.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

/// Why no folder can be made there, without the name of `above`.
std::string refusal(const std::filesystem::path& above, const std::filesystem::path& folder) {
    try {
        makeFolder(above / folder);
    } catch (const InputError& error) {
        CHECK(error.code() == ExitCode::badInput);
        return std::string(error.what()).substr(above.string().size() + 1);
    }
    return "";
}

}  // namespace

TEST_CASE("Write file: folders are made with those that they lie in, and may be there") {
    const TemporaryFolder folder;
    for (const char* name : {"a/b", "a/b/", "a/./c", "a"})
        CHECK(refusal(folder.path(), name) == "");
    CHECK(std::filesystem::is_directory(folder / "a/b"));
    CHECK(std::filesystem::is_directory(folder / "a/c"));
    std::filesystem::create_directory_symlink("a", folder / "link");
    CHECK(refusal(folder.path(), "link") == "");
}

TEST_CASE("Write file: a file in the place of a folder, or of one above it, is named") {
    const TemporaryFolder folder;
    folder.write("file", "");
    for (const char* name : {"file", "file/", "file/a/b", "./file"}) {
        CAPTURE(std::string(name));
        CHECK(refusal(folder.path(), name).ends_with("file: is a file, expected a folder"));
    }
    CHECK_NOTHROW(checkFolder(folder / "a"));
    CHECK_FALSE(std::filesystem::exists(folder / "a"));
}
