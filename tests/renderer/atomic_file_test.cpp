#include "renderer/atomic_file.h"

#include <doctest/doctest.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace {

namespace fs = std::filesystem;
using etendue::readFile;
using etendue::TemporaryFolder;
using etendue::writeFileAtomically;

void write(const fs::path& file, const std::string& text) {
    writeFileAtomically(file, text.data(), text.size());
}

/// The message of the error that writing there gives; empty if it gives none.
std::string errorOf(const fs::path& file, const std::string& text = "new") {
    try {
        write(file, text);
    } catch (const std::runtime_error& error) {
        return error.what();
    }
    return {};
}

unsigned permissions(const fs::path& file) {
    struct stat status {};
    REQUIRE(::stat(file.c_str(), &status) == 0);
    return status.st_mode & 07777U;
}

/// Files of this process cannot grow past `bytes` while this lives: a disk that fills up.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &old_);
        const rlimit limit{bytes, old_.rlim_max};
        REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    void (*handler_)(int);
    rlimit old_{};
};

}  // namespace

TEST_CASE("Atomic file: a new file holds the bytes, and nothing else is left in the folder") {
    const TemporaryFolder folder;
    const std::string bytes("a\0b\n\xff", 5);
    write(folder / "out.exr", bytes);
    CHECK(readFile(folder / "out.exr") == bytes);
    write(folder / "empty", "");
    CHECK(readFile(folder / "empty").empty());
    CHECK(folder.names() == std::vector<std::string>{"empty", "out.exr"});
}

TEST_CASE("Atomic file: a file in the current folder needs no path") {
    const TemporaryFolder folder;
    const fs::path before = fs::current_path();
    fs::current_path(folder / "");
    write("out.exr", "new");
    fs::current_path(before);
    CHECK(readFile(folder / "out.exr") == "new");
}

TEST_CASE("Atomic file: a new file has the umask's permissions, an old one keeps its own") {
    const TemporaryFolder folder;
    const mode_t before = ::umask(027);
    write(folder / "new", "new");
    ::umask(before);
    CHECK(permissions(folder / "new") == 0640U);

    write(folder / "private", "old");
    REQUIRE(::chmod((folder / "private").c_str(), 0600) == 0);
    write(folder / "private", "new");
    CHECK(permissions(folder / "private") == 0600U);
    CHECK(readFile(folder / "private") == "new");
}

TEST_CASE("Atomic file: a symbolic link is written through") {
    const TemporaryFolder folder;
    fs::create_directory(folder / "data");
    write(folder / "data/real", "old");
    fs::create_symlink("data/real", folder / "link");
    fs::create_symlink("link", folder / "link to link");
    write(folder / "link to link", "new");
    CHECK(fs::is_symlink(folder / "link to link"));
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(readFile(folder / "data/real") == "new");

    fs::create_symlink("data/not yet", folder / "dangling");
    write(folder / "dangling", "new");
    CHECK(fs::is_symlink(folder / "dangling"));
    CHECK(readFile(folder / "data/not yet") == "new");

    fs::create_symlink("loop", folder / "loop");
    CHECK(errorOf(folder / "loop") ==
          (folder / "loop").string() + ": cannot write: Too many levels of symbolic links");
}

TEST_CASE("Atomic file: what is left of a dead process with the same id is no hindrance") {
    const TemporaryFolder folder;
    const std::string stale = ".out.exr.tmp-" + std::to_string(::getpid());
    etendue::writeFile(folder / stale, "a longer text than the new one");
    write(folder / "out.exr", "new");
    CHECK(readFile(folder / "out.exr") == "new");
    CHECK(folder.names() == std::vector<std::string>{"out.exr"});
}

TEST_CASE("Atomic file: an impossible target gives the path and the system's reason") {
    const TemporaryFolder folder;
    write(folder / "file", "old");
    fs::create_directory(folder / "directory");
    struct Case {
        fs::path target;
        std::string reason;
    };
    const Case cases[] = {
        {folder / "directory", "Is a directory"},
        {folder / "file/out.exr", "Not a directory"},
        {folder / "missing/out.exr", "No such file or directory"},
        {folder / std::string(300, 'x'), "File name too long"},
    };
    for (const Case& c : cases)
        CHECK(errorOf(c.target) == c.target.string() + ": cannot write: " + c.reason);
    CHECK(folder.names() == std::vector<std::string>{"directory", "file"});
}

TEST_CASE("Atomic file: a pipe is written to, however often a signal interrupts") {
    const TemporaryFolder folder;
    const fs::path pipe = folder / "pipe";
    REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
    // Several times what a pipe holds (64 kB), so that write() has to wait for the reader: a signal
    // then ends it with what it has written so far, or with EINTR.
    std::string sent(300'000, '\0');
    for (std::size_t i = 0; i < sent.size(); ++i) sent[i] = static_cast<char>(i * i / 1000);
    struct sigaction interrupt {
    }, old{};
    interrupt.sa_handler = [](int) {};
    REQUIRE(::sigaction(SIGUSR1, &interrupt, &old) == 0);

    std::string error, received;
    std::thread writer([&] { error = errorOf(pipe, sent); });
    const int reader = ::open(pipe.c_str(), O_RDONLY);
    std::array<char, 10'000> block;
    ssize_t size = 0;
    while ((size = ::read(reader, block.data(), block.size())) > 0) {
        received.append(block.data(), static_cast<std::size_t>(size));
        for (int signals = 0; signals < 3; ++signals) {
            ::pthread_kill(writer.native_handle(), SIGUSR1);
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    writer.join();
    ::close(reader);
    ::sigaction(SIGUSR1, &old, nullptr);
    CHECK(error.empty());
    CHECK(received == sent);
    CHECK(fs::is_fifo(pipe));
    CHECK(folder.names() == std::vector<std::string>{"pipe"});
}

TEST_CASE("Atomic file: when the disk is full the old file stays and no temporary is left") {
    const TemporaryFolder folder;
    write(folder / "out.exr", "old");
    {
        // The first write() is short, the second fails.
        const FileSizeLimit limit(1000);
        CHECK(errorOf(folder / "out.exr", std::string(5000, 'x')) ==
              (folder / "out.exr").string() + ": cannot write: File too large");
    }
    CHECK(readFile(folder / "out.exr") == "old");
    CHECK(folder.names() == std::vector<std::string>{"out.exr"});
}

TEST_CASE("Atomic file: a reader sees the old file or the whole new one, never a part") {
    const TemporaryFolder folder;
    const fs::path file = folder / "out.exr";
    const std::size_t size = 100'000;
    write(file, std::string(size, 'a'));
    std::atomic<bool> isDone = false;
    std::atomic<int> parts = 0;
    std::thread reader([&] {
        do {
            const std::string text = readFile(file);
            if (text.size() != size || text.find_first_not_of(text[0]) != std::string::npos)
                ++parts;
        } while (!isDone);
    });
    for (int i = 0; i < 30; ++i) write(file, std::string(size, static_cast<char>('a' + i % 26)));
    isDone = true;
    reader.join();
    CHECK(parts == 0);
}
