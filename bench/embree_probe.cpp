#include "bench/embree_probe.h"

#include <embree3/rtcore.h>

#include <chrono>
#include <vector>

namespace etendue {
namespace {

using Clock = std::chrono::steady_clock;

struct RecordedQuery {
    RTCScene scene;
    bool isOcclusion;
    RTCRayHit query;
};

EmbreeProbe mode = EmbreeProbe::off;
EmbreeUse use;
std::vector<RecordedQuery> recorded;

template <class Query>
void timed(const Query& query) {
    // Longer than any query takes: another program had the processor.
    constexpr double longestNanoseconds = 20000.0;
    const auto start = Clock::now();
    query();
    const double time = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    if (time > longestNanoseconds) return;
    ++use.timed;
    use.nanosecondsInside += time;
}

}  // namespace

void probeEmbree(EmbreeProbe probe) {
    mode = probe;
    use = {};
    if (probe == EmbreeProbe::recording) recorded.clear();
}

EmbreeUse embreeUse() { return use; }

TimingCost embreeTimingCost() {
    constexpr int count = 1000000;
    const EmbreeUse before = use;
    use = {};
    const double start = threadSeconds();
    for (int i = 0; i < count; ++i) timed([] {});
    const double whole = (threadSeconds() - start) * 1e9;
    const TimingCost cost{whole / count, use.nanosecondsInside / static_cast<double>(use.timed)};
    use = before;
    return cost;
}

}  // namespace etendue

extern "C" {
void __real_rtcIntersect1(RTCScene, RTCIntersectContext*, RTCRayHit*);
void __real_rtcOccluded1(RTCScene, RTCIntersectContext*, RTCRay*);

void __wrap_rtcIntersect1(RTCScene scene, RTCIntersectContext* context, RTCRayHit* query) {
    using namespace etendue;
    if (mode == EmbreeProbe::off) return __real_rtcIntersect1(scene, context, query);
    ++use.closestHits;
    if (mode == EmbreeProbe::recording) recorded.push_back({scene, false, *query});
    if (mode == EmbreeProbe::timing)
        timed([&] { __real_rtcIntersect1(scene, context, query); });
    else
        __real_rtcIntersect1(scene, context, query);
    use.met += query->hit.geomID != RTC_INVALID_GEOMETRY_ID;
}

void __wrap_rtcOccluded1(RTCScene scene, RTCIntersectContext* context, RTCRay* ray) {
    using namespace etendue;
    if (mode == EmbreeProbe::off) return __real_rtcOccluded1(scene, context, ray);
    ++use.occlusions;
    if (mode == EmbreeProbe::recording) recorded.push_back({scene, true, {*ray, {}}});
    if (mode == EmbreeProbe::timing)
        timed([&] { __real_rtcOccluded1(scene, context, ray); });
    else
        __real_rtcOccluded1(scene, context, ray);
}
}

namespace etendue {

double replayNanosecondsPerQuery() {
    const double start = threadSeconds();
    for (const RecordedQuery& r : recorded) {
        RTCIntersectContext context;
        rtcInitIntersectContext(&context);
        RTCRayHit query = r.query;
        if (r.isOcclusion)
            __real_rtcOccluded1(r.scene, &context, &query.ray);
        else
            __real_rtcIntersect1(r.scene, &context, &query);
    }
    return (threadSeconds() - start) * 1e9 / static_cast<double>(recorded.size());
}

}  // namespace etendue
