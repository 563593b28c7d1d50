#include "tools/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace etendue {

namespace {

constexpr int barWidth = 28;

double secondsLeft(const RenderProgress& p) {
    return p.fractionDone > 0.0 ? p.seconds * (1.0 - p.fractionDone) / p.fractionDone : 0.0;
}

/// "32/64 spp", or "32 spp" where time alone ends the render.
std::string formatSamples(const RenderProgress& p) {
    return p.samplesTarget == unlimitedSamples
               ? fmt::format("{} spp", p.samplesDone)
               : fmt::format("{}/{} spp", p.samplesDone, p.samplesTarget);
}

std::string formatRate(double perSecond) {
    return perSecond >= 1e6 ? fmt::format("{:.2f} M samples/s", perSecond * 1e-6)
                            : fmt::format("{:.0f} k samples/s", perSecond * 1e-3);
}

double secondsSince(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::string describe(const RenderProgress& p, bool isLast) {
    return fmt::format(
        "{}  {}  {}", formatSamples(p), formatRate(p.cameraSamplesPerSecond),
        isLast ? "in " + formatDuration(p.seconds) : "ETA " + formatDuration(secondsLeft(p)));
}

}  // namespace

std::string formatDuration(double seconds) {
    if (seconds < 60.0) return fmt::format("{:.1f} s", seconds);
    const auto total = static_cast<long>(seconds + 0.5);
    if (total < 3600) return fmt::format("{}:{:02}", total / 60, total % 60);
    return fmt::format("{}:{:02}:{:02}", total / 3600, total / 60 % 60, total % 60);
}

FitBar::FitBar() : isTerminal_(isatty(STDERR_FILENO) != 0) {}

void FitBar::update(double share, std::string_view stage) {
    if (isTerminal_) {
        const int filled = static_cast<int>(std::lround(share * barWidth));
        say(fmt::format("\r[{:#<{}}{:.<{}}] {}\033[K", "", filled, "", barWidth - filled, stage));
    } else if (stage != stage_) {
        say(fmt::format("  {:3.0f} %  {}\n", 100.0 * share, stage));
    }
    stage_ = stage;
}

void FitBar::clear() const {
    if (isTerminal_ && !stage_.empty()) say("\r\033[K");
}

JobBar::JobBar(std::size_t jobs, double secondsEach)
    : isTerminal_(isatty(STDERR_FILENO) != 0), jobs_(jobs), secondsEach_(secondsEach) {}

void JobBar::update(const std::string& name, double share) {
    constexpr double interval = 0.1;
    const double seconds = secondsSince(start_);
    if (!isTerminal_ || seconds - lastSeconds_ < interval) return;
    lastSeconds_ = seconds;
    const double done = static_cast<double>(done_) + share;
    const int filled = static_cast<int>(done / static_cast<double>(jobs_) * barWidth);
    say(fmt::format("\r[{:#<{}}{:.<{}}] {}/{}  {}  ETA {}\033[K", "", filled, "", barWidth - filled,
                    done_ + 1, jobs_, name, formatDuration(secondsLeft(share))));
}

void JobBar::finishJob(const std::string& outcome) {
    ++done_;
    if (!isTerminal_)
        say(fmt::format("  {}/{}  {}  ETA {}\n", done_, jobs_, outcome,
                        formatDuration(secondsLeft(0.0))));
}

void JobBar::skipJobs(std::size_t count) {
    done_ += count;
    skipped_ += count;
}

void JobBar::clear() const {
    if (isTerminal_) say("\r\033[K");
}

double JobBar::secondsLeft(double share) const {
    const double done = static_cast<double>(done_) + share;
    const double timed = done - static_cast<double>(skipped_);
    const double each = done_ > skipped_ ? secondsSince(start_) / timed : secondsEach_;
    return std::max(0.0, (static_cast<double>(jobs_) - done) * each);
}

void say(const std::string& text) {
    std::fputs(text.c_str(), stderr);
    std::fflush(stderr);
}

Progress::Progress(ProgressStyle style) : style_(style) {
    if (style_ == ProgressStyle::automatic)
        style_ = isatty(STDERR_FILENO) ? ProgressStyle::bar : ProgressStyle::lines;
}

void Progress::update(const RenderProgress& progress) {
    const double interval = style_ == ProgressStyle::lines ? 10.0 : 0.1;
    // The last one is for finish() to report.
    if (progress.fractionDone >= 1.0 || progress.seconds - lastSeconds_ < interval) return;
    lastSeconds_ = progress.seconds;
    write(progress, false);
}

void Progress::finish(const RenderProgress& progress) { write(progress, true); }

void Progress::write(const RenderProgress& p, bool isLast) {
    switch (style_) {
        case ProgressStyle::quiet:
        case ProgressStyle::automatic:
            return;
        case ProgressStyle::json:
            say(fmt::format(
                "{{\"samples\":{},\"target\":{},\"seconds\":{:.3f},\"samples_per_second\":{:.0f},"
                "\"eta_seconds\":{:.3f},\"done\":{}}}\n",
                p.samplesDone, p.samplesTarget, p.seconds, p.cameraSamplesPerSecond,
                isLast ? 0.0 : secondsLeft(p), isLast));
            return;
        case ProgressStyle::lines:
            say(describe(p, isLast) + "\n");
            return;
        case ProgressStyle::bar: {
            const int filled = static_cast<int>(p.fractionDone * barWidth);
            const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                                    std::string(static_cast<std::size_t>(barWidth - filled), '.');
            // Erase to the end of the line: a shorter line follows a longer one.
            say(fmt::format("\r[{}] {}\033[K{}", bar, describe(p, isLast), isLast ? "\n" : ""));
            return;
        }
    }
}

}  // namespace etendue
