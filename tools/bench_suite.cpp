#include "tools/bench_suite.h"

#include <fmt/format.h>

#include "renderer/content_hash.h"
#include "renderer/estimator.h"

namespace etendue {

namespace {

std::vector<std::string> textsOr(const ConfigTable& table, const char* key,
                                 const std::vector<std::string>& fallback) {
    return table.has(key) ? table.texts(key) : fallback;
}

std::vector<BenchVariant> loadVariants(const ConfigTable& group) {
    std::vector<BenchVariant> variants;
    for (const ConfigTable& table : group.tables("variant")) {
        BenchVariant variant{table.text("name"), table.texts("set")};
        table.finish();
        for (const BenchVariant& other : variants)
            if (other.name == variant.name) table.fail("name", "is another variant's, too");
        variants.push_back(std::move(variant));
    }
    if (variants.empty()) variants.emplace_back();
    return variants;
}

std::vector<std::string> loadEstimators(const ConfigTable& group) {
    const std::vector<std::string> estimators = textsOr(group, "estimators", estimatorKinds());
    for (const std::string& name : estimators) {
        const auto& known = estimatorKinds();
        if (std::find(known.begin(), known.end(), name) == known.end())
            group.fail("estimators", fmt::format("no estimator is called \"{}\"", name));
    }
    return estimators;
}

bool isSameView(const BenchView& a, const BenchView& b) {
    return a.scene.name == b.scene.name && a.camera.name == b.camera.name;
}

void loadGroup(const ConfigTable& group, const std::filesystem::path& folder, BenchSuite& suite) {
    BenchView view;
    view.overrides = group.texts("set");
    view.variants = loadVariants(group);
    view.estimators = loadEstimators(group);
    const std::vector<std::string> scenes = group.texts("scenes");
    for (const NamedFile& scene : scenesCalled(scenes, folder))
        for (const std::string& camera : textsOr(group, "cameras", {"own"})) {
            view.scene = scene;
            view.camera = cameraCalled(camera, folder);
            for (const BenchView& other : suite.views)
                if (isSameView(view, other))
                    group.fail("scenes", fmt::format("{} is in another group, too",
                                                     titleOf(view.scene, view.camera)));
            suite.views.push_back(view);
        }
    group.finish();
}

}  // namespace

std::size_t BenchSuite::runCount() const {
    std::size_t count = 0;
    for (const BenchView& view : views)
        count += view.variants.size() * view.estimators.size() * static_cast<std::size_t>(seeds);
    return count;
}

std::string BenchSuite::key() const {
    std::string text = fmt::format("{} {} {} {} {} {} {} {} {} {}\n", width, height, seeds, seconds,
                                   mostSamples, targetRelMse, referenceSeconds, referenceEstimator,
                                   wantsTechniques, wantsFitErrors);
    for (const BenchView& view : views) {
        text += titleOf(view.scene, view.camera);
        for (const std::string& assignment : view.overrides) text += " -s " + assignment;
        for (const std::string& name : view.estimators) text += " " + name;
        for (const BenchVariant& variant : view.variants) {
            text += "\n  " + variant.name;
            for (const std::string& assignment : variant.overrides) text += " -s " + assignment;
        }
        text += "\n";
    }
    return contentHash({}, {text});
}

BenchSuite loadBenchSuite(const std::filesystem::path& file) {
    const ConfigTable root = Config::load(file).root();
    const ConfigTable table = root.table("suite");
    BenchSuite suite;
    suite.title = table.text("title", file.stem().string());
    suite.width = static_cast<int>(table.integer("width", {1, 4096}, suite.width));
    suite.height = static_cast<int>(table.integer("height", {1, 4096}, suite.height));
    suite.seeds = static_cast<int>(table.integer("seeds", {2, 1000}, suite.seeds));
    suite.seconds = table.number("seconds", {1e-3, 1e6}, suite.seconds);
    suite.mostSamples =
        static_cast<std::uint32_t>(table.integer("most_samples", {1, 1 << 30}, suite.mostSamples));
    suite.targetRelMse = table.number("target_relmse", Range::positive(), suite.targetRelMse);
    suite.referenceSeconds = table.number("reference_seconds", {1e-3, 1e7}, suite.referenceSeconds);
    suite.referenceEstimator =
        table.choice("reference_estimator", estimatorKinds(), suite.referenceEstimator);
    suite.wantsTechniques = table.boolean("techniques", suite.wantsTechniques);
    suite.wantsFitErrors = table.boolean("fit_errors", suite.wantsFitErrors);
    const std::filesystem::path above = std::filesystem::absolute(file).parent_path().parent_path();
    const std::filesystem::path folder =
        table.has("folder") ? std::filesystem::absolute(file).parent_path() / table.text("folder")
                            : above;
    table.finish();
    const std::vector<ConfigTable> groups = root.tables("group");
    if (groups.empty()) root.fail("group", "a suite needs at least one [[group]] of scenes");
    for (const ConfigTable& group : groups) loadGroup(group, folder, suite);
    root.finish();
    return suite;
}

}  // namespace etendue
