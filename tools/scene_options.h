// Options that several commands share. CLI11 is known to main.cpp, lens_command.cpp,
// bench_options.cpp and the two headers that these share alone.
#pragma once

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "renderer/sample_ranges.h"
#include "tools/option_checks.h"
#include "tools/preview.h"

namespace etendue {

inline void addCamera(CLI::App* command, std::filesystem::path& camera) {
    command
        ->add_option("--camera", camera,
                     "Look through this file's [camera], such as scenes/cameras/fisheye.toml")
        ->type_name("FILE");
}

inline void addPreview(CLI::App* command, Preview& preview) {
    command->add_option("--preview", preview.file, "Also write an sRGB PNG")->type_name("FILE");
    command->add_option("--exposure", preview.exposureStops, "Added to the PNG, not to the EXR")
        ->check(numberBetween(-100.0, 100.0))
        ->type_name("STOPS");
}

inline void addSet(CLI::App* command, std::vector<std::string>& overrides) {
    command->add_option("-s,--set", overrides, "Override any key of the scene; may be repeated")
        ->allow_extra_args(false)
        ->type_name("KEY=VALUE");
}

/// And a name of its own for the override that is wanted most. CLI11 takes options in the order in
/// which they are added here: --set has filled `overrides` by the time that --estimator adds to it.
inline void addOverrides(CLI::App* command, std::vector<std::string>& overrides) {
    addSet(command, overrides);
    command
        ->add_option_function<std::string>(
            "--estimator",
            [&overrides](const std::string& name) {
                overrides.push_back("estimator.kind=" + name);
            },
            "pt, lt or bdpt; short for -s estimator.kind=NAME")
        ->type_name("NAME");
}

inline void addSeed(CLI::App* command, std::uint64_t& seed) {
    command->add_option("--seed", seed, "Of the random numbers; default 0")
        ->check(numberThat<std::uint64_t>([](std::uint64_t) { return true; },
                                          "a whole number from 0 to 2^64 - 1"))
        ->type_name("N");
}

inline void addThreads(CLI::App* command, std::optional<int>& threads) {
    command->add_option("--threads", threads, "Default: one for each processor")
        ->check(CLI::Range(1, 1024).description(""))
        ->type_name("N");
}

/// "A:B": samples A … B − 1.
inline void addSampleRange(CLI::App* command, const char* name, std::optional<SampleRange>& range,
                           const char* description) {
    command
        ->add_option_function<std::string>(
            name,
            [name, &range](const std::string& text) {
                range = parseSampleRange(text);
                if (!range)
                    throw CLI::ValidationError(
                        name, fmt::format("expected A:B, two whole numbers with A < B ≤ 2^30, got "
                                          "\"{}\"",
                                          text));
            },
            description)
        ->type_name("A:B");
}

inline void addSize(CLI::App* command, std::vector<int>& size, const char* description) {
    command->add_option("--size", size, description)
        ->delimiter(',')
        ->expected(2)
        ->check(CLI::Range(1, 32768).description(""))
        ->type_name("W,H");
}

}  // namespace etendue
