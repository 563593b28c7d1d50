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

/// Throws the error at the one of the table's overrides that it names. Returns if it names none.
void failOverride(const ConfigTable& table, const std::vector<std::string>& overrides,
                  const InputError& error) {
    const std::string message = error.what();
    for (std::size_t i = 0; i < overrides.size(); ++i) {
        const std::string option = overrideName(overrides[i]);
        if (message.starts_with(option + ": "))  // which nobody has typed
            table.failEntry("set", i, message.substr(option.size() + 2), error.code());
        if (message.find("named by " + option + ", ") != std::string::npos)
            table.failEntry("set", i, message, error.code());
    }
}

std::vector<std::string> loadOverrides(const ConfigTable& table) {
    std::vector<std::string> overrides = table.texts("set");
    bool setsKind = false;
    try {
        setsKind = isEstimatorKindSet(overrides);
    } catch (const InputError& error) {
        failOverride(table, overrides, error);
        throw;
    }
    if (setsKind)
        table.fail("set", "estimator.kind has no effect; the group's estimators are compared");
    return overrides;
}

/// What `find` finds by the names under the key.
template <class Find>
auto findNamed(const ConfigTable& table, const char* key, const Find& find) {
    try {
        return find();
    } catch (const InputError& error) {
        table.fail(key, error.what(), error.code());
    }
}

std::vector<BenchVariant> loadVariants(const ConfigTable& group) {
    std::vector<BenchVariant> variants;
    for (const ConfigTable& table : group.tables("variant")) {
        BenchVariant variant{table.text("name"), loadOverrides(table), table};
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

bool isSameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code ignored;  // the scene's own camera has no file
    return a == b || std::filesystem::equivalent(a, b, ignored);
}

void loadGroup(const ConfigTable& group, const std::filesystem::path& folder, BenchSuite& suite) {
    BenchView view;
    view.group = group;
    view.overrides = loadOverrides(group);
    view.variants = loadVariants(group);
    view.estimators = loadEstimators(group);
    const std::vector<std::string> scenes = group.texts("scenes");
    for (const NamedFile& scene :
         findNamed(group, "scenes", [&] { return scenesCalled(scenes, folder); }))
        for (const std::string& camera : textsOr(group, "cameras", {"own"})) {
            view.scene = scene;
            view.camera = findNamed(group, "cameras", [&] { return cameraCalled(camera, folder); });
            if (const auto clash = nameClash(suite, view)) group.fail("scenes", *clash);
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

std::optional<std::string> nameClash(const BenchSuite& suite, const BenchView& view) {
    for (const BenchView& other : suite.views) {
        for (const auto file : {&BenchView::scene, &BenchView::camera}) {
            const NamedFile &a = other.*file, &b = view.*file;
            if (a.name == b.name && !isSameFile(a.file, b.file))
                return fmt::format("{} and {} are both called \"{}\"", a.file.string(),
                                   b.file.string(), a.name);
        }
        if (other.scene.name == view.scene.name && other.camera.name == view.camera.name)
            return titleOf(view.scene, view.camera) + " is there twice";
    }
    return {};
}

void failLoading(const BenchView& view, const BenchVariant& variant, const InputError& error) {
    if (!view.group) throw error;
    if (variant.table && !variant.overrides.empty()) {
        failOverride(*variant.table, variant.overrides, error);
        variant.table->fail("set", error.what(), error.code());
    }
    failOverride(*view.group, view.overrides, error);
    const std::string message = error.what(), camera = view.camera.file.string();
    const bool isCamera = !camera.empty() && message.find(camera) != std::string::npos;
    view.group->failNamedFile(isCamera ? "cameras" : "scenes", error);
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
