#include "tools/agreement_judge.h"

#include <algorithm>
#include <cmath>

namespace etendue {

double guardedP(const WelchResult& welch, double step) {
    const double difference = std::abs(welch.difference);
    if (!(difference * step > 0.0)) return welch.pValue;
    // What has been missed comes in a Poisson number of steps; none is larger, so that none of
    // them makes a larger variance of the same mean.
    const double variance = welch.standardError * welch.standardError + difference * step;
    const double p = studentTwoSidedP(difference / std::sqrt(variance), welch.degreesOfFreedom);
    return std::max(p, welch.pValue);
}

double guardedP(std::span<const double> a, std::span<const double> b, double largestStepOfA,
                double largestStepOfB) {
    WelchResult welch = welchTest(a, b);
    const double least = static_cast<double>(std::min(a.size(), b.size())) - 1.0;
    welch.degreesOfFreedom = std::max(welch.degreesOfFreedom, least);
    return guardedP(welch, welch.difference < 0.0 ? largestStepOfA : largestStepOfB);
}

Judgement judgePictures(const std::vector<Picture>& a, const std::vector<Picture>& b,
                        SampleSizes sizesOfA, SampleSizes sizesOfB, int width, int tileSize,
                        std::size_t comparisons) {
    struct Test {
        double guarded, plain;  // p
    };
    std::vector<Test> tests;
    const auto pOf = [&](std::span<const double> meansA, std::span<const double> meansB,
                         int pixels) {
        const auto step = [&](SampleSizes sizes) {
            return sizes.largest / (sizes.samplesPerPixel * pixels);
        };
        tests.push_back({guardedP(meansA, meansB, step(sizesOfA), step(sizesOfB)),
                         welchP(meansA, meansB, pixels)});
        return tests.back().guarded;
    };
    Judgement result{comparePictures(a, b, width, tileSize, comparisons, pOf)};
    const double level = result.comparison.level;
    result.testsInDoubt = static_cast<std::size_t>(std::ranges::count_if(
        tests, [=](Test test) { return test.guarded > level && test.plain <= level; }));
    return result;
}

}  // namespace etendue
