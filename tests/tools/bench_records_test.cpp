// Records of a benchmark: nothing is lost on the way to the file and back.
#include "tools/bench_records.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "config/config.h"
#include "tests/support/temporary_folder.h"

using namespace etendue;

namespace {

BenchRun exampleRun(int seed) {
    return {{"box", "wide", "8 \"terms\"", "bdpt"},
            seed,
            "abc",
            0.25,
            7,
            0.125,
            {{1, 0.1, {1.0, 2.0, 3.0, 4.0, std::numeric_limits<double>::quiet_NaN()}},
             {2, 0.1 + 0.2, {0.5, 1.0, 1.5, 2.0, -0.25}}}};
}

}  // namespace

TEST_CASE("Bench records: what is appended is read back") {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "results.jsonl";
    CHECK(readBenchRecords(file).runs.empty());
    BenchHeader header;
    header.title = "Title";
    header.key = "key";
    header.cores = 2;
    appendRecord(file, header);
    appendRecord(file, BenchReference{"box", "wide", "bdpt", "k", 1u << 20, 60.5, 1e-5});
    appendRecord(file, BenchLens{"wide", "", "two-point", 40.0, 0.1, {}, 41.5, 300.25});
    appendRecord(file, exampleRun(0));
    appendRecord(file, exampleRun(1));
    const BenchRecords records = readBenchRecords(file);
    CHECK(records.header.value().title == "Title");
    CHECK(records.header.value().cores == 2);
    CHECK(records.references.at(0).samples == 1u << 20);
    CHECK(records.references.at(0).relMse == 1e-5);
    CHECK(records.lenses.at(0).terms == 40.0);
    CHECK(!records.lenses.at(0).fitErrorMicrometres);
    CHECK(records.lenses.at(0).connectNs == 300.25);
    REQUIRE(records.runs.size() == 2);
    const BenchRun& run = records.runs.at(1);
    CHECK(run.configuration == exampleRun(1).configuration);
    CHECK(run.seed == 1);
    CHECK(run.badSamples == 7);
    CHECK(run.flip == 0.125);
    CHECK(run.checkpoints.at(1).seconds == 0.1 + 0.2);
    CHECK(run.checkpoints.at(1).errors.meanError == -0.25);
    CHECK(std::isnan(run.checkpoints.at(0).errors.meanError));
}

TEST_CASE("Bench records: a line cut short is dropped, and the next one begins a line") {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "results.jsonl";
    appendRecord(file, exampleRun(0));
    const std::string one = readFile(file);
    appendRecord(file, exampleRun(1));
    const std::string two = readFile(file);
    for (std::size_t size = one.size() + 1; size < two.size(); size += 40) {
        folder.write("results.jsonl", two.substr(0, size));
        CHECK(readBenchRecords(file).runs.size() == 1);
        CHECK(readFile(file) == one);
    }
    appendRecord(file, exampleRun(1));
    CHECK(readFile(file) == two);
}

TEST_CASE("Bench records: any other line is refused by its number") {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "results.jsonl";
    appendRecord(file, exampleRun(0));
    const std::string one = readFile(file);
    for (const char* line : {"{\"kind\": \"walk\"}\n", "{\"kind\": \"run\"}\n", "nonsense\n", "\n",
                             "{\"kind\": \"run\", \"scene\": 3}\n"}) {
        CAPTURE(std::string(line));
        folder.write("results.jsonl", one + line);
        std::string message;
        try {
            readBenchRecords(file);
        } catch (const InputError& error) {
            message = error.what();
        }
        CHECK(message.find("results.jsonl:2: not a record of a benchmark") != std::string::npos);
    }
}

TEST_CASE("Bench records: a run that is there twice is refused by the number of its line") {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "results.jsonl";
    BenchRun other = exampleRun(0);
    other.configuration.estimator = "pt";
    for (const BenchRun& run : {exampleRun(0), exampleRun(1), other}) appendRecord(file, run);
    CHECK(readBenchRecords(file).runs.size() == 3);
    appendRecord(file, exampleRun(1));
    appendRecord(file, exampleRun(2));
    CHECK_THROWS_WITH_AS(
        readBenchRecords(file),
        doctest::Contains("results.jsonl:4: box, wide, 8 \"terms\", bdpt, seed 1 is there twice"),
        InputError);
}

TEST_CASE("Bench records: the table has a row for each checkpoint") {
    const std::string csv = csvOf({exampleRun(3)});
    CHECK(csv.find("\"box\",\"wide\",\"8 \"\"terms\"\"\",bdpt,3,2,0.30000000000000004,0.5,1,1.5,2,"
                   "-0.25\n") != std::string::npos);
    CHECK(std::count(csv.begin(), csv.end(), '\n') == 3);
}
