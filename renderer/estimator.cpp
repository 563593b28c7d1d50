#include "renderer/estimator.h"

#include <stdexcept>

namespace etendue {

namespace {

struct Kind {
    const char* name;
    std::unique_ptr<Estimator> (*make)(const EstimatorSettings&);
};

constexpr Kind kinds[] = {
    {"pt", makePathTracer},
};

}  // namespace

const std::vector<std::string>& estimatorKinds() {
    static const std::vector<std::string> names = [] {
        std::vector<std::string> result;
        for (const Kind& k : kinds) result.emplace_back(k.name);
        return result;
    }();
    return names;
}

std::unique_ptr<Estimator> makeEstimator(const EstimatorSettings& settings) {
    for (const Kind& k : kinds)
        if (settings.kind == k.name) return k.make(settings);
    throw std::invalid_argument("unknown estimator '" + settings.kind + "'");
}

}  // namespace etendue
