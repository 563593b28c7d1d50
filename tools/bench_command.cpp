#include "tools/bench_command.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/parallel.h"
#include "tools/agreement_report.h"
#include "tools/progress.h"
#include "tools/scene_names.h"
#include "tools/stop_request.h"

namespace etendue {

namespace {

/// Which estimator is compared with which.
struct Pair {
    Contender tested, reference;
};

/// Single techniques are held against path tracing, which shares no code with them; but it meets
/// the light itself only by chance if that is small.
std::vector<Pair> techniquesUpTo(int edges) {
    std::vector<Pair> pairs;
    for (int k = 1; k <= edges; ++k)
        for (int s = 0; s <= k; ++s)
            pairs.push_back({{"bdpt", Technique{s, k + 1 - s}}, {k == 1 ? "bdpt" : "pt", {}}});
    return pairs;
}

std::vector<Pair> pairsOf(const AgreementCommand& command) {
    if (command.techniqueEdges > 0) return techniquesUpTo(command.techniqueEdges);
    const bool isDefault = command.estimators.empty() && command.reference.empty();
    if (isDefault) return {{{"lt", {}}, {}}, {{"bdpt", {}}, {}}, {{"lt", {}}, {"bdpt", {}}}};
    const std::vector<std::string> both{"lt", "bdpt"};
    const std::string reference = command.reference.empty() ? "pt" : command.reference;
    std::vector<Pair> pairs;
    for (const std::string& name : command.estimators.empty() ? both : command.estimators)
        pairs.push_back({parseContender(name).value(), parseContender(reference).value()});
    for (const auto& [tested, other] : pairs)
        if (tested.technique && other.technique && !isAsLong(*tested.technique, *other.technique))
            throw InputError(fmt::format("{} and {} make paths of different lengths",
                                         nameOf(tested), nameOf(other)),
                             ExitCode::usage);
    return pairs;
}

/// A run over the matrix.
class AgreementRun {
public:
    explicit AgreementRun(const AgreementCommand& command)
        : command_(command),
          scenes_(scenesCalled(command.scenes, command.folder)),
          pairs_(pairsOf(command)) {
        if (isEstimatorKindSet(command.overrides))
            throw InputError(
                "-s estimator.kind: has no effect; --estimators names what is compared",
                ExitCode::usage);
        for (const std::string& name : command.cameras)
            cameras_.push_back(cameraCalled(name, command.folder));
        settings_.seeds = command.seeds;
        settings_.samples = command.samples;
        settings_.seconds = command.seconds;
        settings_.bound = 0.01 * command.boundPercent;
        settings_.threads = command.threads.value_or(hardwareThreads());
        settings_.comparisons = scenes_.size() * cameras_.size() * pairs_.size();
        settings_.reckonsTime = command.reckonsTime;
        settings_.keepsByChance = command.keepsByChance;
        if (command.sampler == "independent") settings_.sampler = Sampler::independent;
        if (command.sampler == "scene") settings_.sampler.reset();
        settings_.firstSeed = command.firstSeed;
    }

    void run() {
        JobBar bar(settings_.comparisons, settings_.seconds);
        for (const NamedFile& scene : scenes_)
            for (const NamedFile& camera : cameras_) compareThrough(scene, camera, bar);
        bar.clear();
    }

    const std::vector<AgreementRow>& rows() const { return rows_; }
    const AgreementSettings& settings() const { return settings_; }

private:
    void compareThrough(const NamedFile& scene, const NamedFile& camera, JobBar& bar) {
        std::optional<LoadedScene> loaded;
        std::string failure;
        const ViewOptions view{command_.overrides, command_.size[0], command_.size[1],
                               settings_.threads};
        try {
            if (!isStopRequested()) loaded = loadView(scene, camera, view, bar);
            if (loaded && loaded->camera->settings().outerPupil)
                throw InputError("estimator.pupil_sampling = \"outer\" is not compared");
        } catch (const InputError& error) {
            failure = error.what();
            loaded.reset();
        }
        for (const Pair& pair : pairs_) {
            AgreementRow row{scene.name, camera.name, nameOf(pair.tested), nameOf(pair.reference),
                             {},         failure};
            if (loaded) compare(*loaded, pair, row, bar);
            settings_.firstSeed += agreementSeeds(settings_);
            if (row.result || !row.failure.empty())
                bar.finishJob(fmt::format("{}: {}", titleOf(row), outcomeOf(row)));
            rows_.push_back(row);
        }
    }

    void compare(const LoadedScene& loaded, const Pair& pair, AgreementRow& row,
                 JobBar& bar) const {
        if (isStopRequested()) return;
        for (const Contender* contender : {&pair.tested, &pair.reference})
            if (contender->technique && contender->technique->s == 0 &&
                hasLightWithoutExtent(*loaded.scene)) {
                row.isIncomplete = true;
                return;
            }
        row.result =
            compareEstimators(loaded, pair.tested, pair.reference, settings_, [&](double seconds) {
                bar.update(titleOf(row), std::min(1.0, seconds / settings_.seconds));
                return !isStopRequested();
            });
    }

    const AgreementCommand& command_;
    std::vector<NamedFile> scenes_, cameras_;
    std::vector<Pair> pairs_;
    AgreementSettings settings_;
    std::vector<AgreementRow> rows_;
};

}  // namespace

ExitCode runAgreement(const AgreementCommand& command) {
    heedStopRequests();
    AgreementRun agreement(command);
    agreement.run();
    if (command.asJson)
        fmt::print("{}\n", agreementJson(agreement.rows(), agreement.settings()).text());
    else
        fmt::print("{}", agreementText(agreement.rows(), agreement.settings()));
    return exitCodeOf(agreement.rows(), command.mustAgree);
}

}  // namespace etendue
