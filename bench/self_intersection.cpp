// How often a ray that leaves a surface meets it again, by the size of the offset:
// docs/precision.md.
#include <fmt/format.h>

#include "renderer/intersector.h"
#include "renderer/material.h"
#include "renderer/mesh_normals.h"
#include "renderer/random.h"
#include "renderer/sampling.h"
#include "renderer/shapes.h"

namespace etendue {
namespace {

struct Failures {
    int tried = 0, outward = 0, inward = 0;
};

/// The surface's own point offset by `share` of its error bound.
Failures leaveSphere(double radius, Vec3d center, bool isInstanced, float share) {
    Mesh mesh = makeSphere(160);
    makeFlat(mesh);
    const Transform place = Transform::translate(center) *
                            Transform::scale({radius, radius, radius}) *
                            Transform::rotate(normalize(Vec3d{1, 2, 3}), 40);
    const Material material;
    Instance instance{0, !isInstanced, {}, {}, {&material}, {}};
    if (isInstanced) {
        instance.worldFromMesh = place;
        instance.meshFromWorld = place.inverse();
    } else {
        for (Vec3& p : mesh.positions) p = toFloat(place.point(toDouble(p)));
    }
    const Intersector intersector({&mesh, 1}, {&instance, 1}, 1);
    Failures f;
    for (std::uint32_t i = 0; i < 200000; ++i) {
        RandomStream random(5, i, 0, RandomDomain::test);
        const Vec3 aim = sampleUnitSphere(random.next2()), from = sampleUnitSphere(random.next2());
        const Vec3 origin = toFloat(center + toDouble(from) * (3.0 * radius));
        const Vec3 direction = normalize(toFloat(center + toDouble(aim) * (0.9 * radius)) - origin);
        const auto hit = intersector.closestHit({origin, direction});
        if (!hit) continue;
        SurfacePoint point(mesh, instance, *hit);
        point.positionError *= share;
        const Vec3 out = Frame::fromZ(point.geometricNormal)
                             .worldFromLocal(sampleCosineHemisphere(random.next2()));
        ++f.tried;
        f.outward += intersector.closestHit({offsetOrigin(point, out), out}).has_value();
        f.inward += !intersector.closestHit({offsetOrigin(point, -out), -out}).has_value();
    }
    return f;
}

}  // namespace
}  // namespace etendue

int main() {
    using namespace etendue;
    struct Case {
        const char* name;
        double radius;
        Vec3d center;
    };
    const Case cases[] = {{"radius 1e-4", 1e-4, {}},
                          {"radius 1", 1.0, {}},
                          {"radius 1e6", 1e6, {}},
                          {"radius 1, 2 km off", 1.0, {1000, -2000, 500}}};
    fmt::print(
        "rays that meet the surface they leave, or miss the sphere they enter, per million\n");
    fmt::print("{:<20} {:>10} {:>8} {:>8} {:>8} {:>8} {:>8}\n", "sphere", "instance", "0", "1/8",
               "1/4", "1/2", "1");
    for (const Case& c : cases)
        for (const bool isInstanced : {false, true}) {
            fmt::print("{:<20} {:>10}", c.name, isInstanced ? "yes" : "no");
            for (const float share : {0.0f, 0.125f, 0.25f, 0.5f, 1.0f}) {
                const Failures f = leaveSphere(c.radius, c.center, isInstanced, share);
                fmt::print(" {:>8.0f}", 1e6 * (f.outward + f.inward) / (2.0 * f.tried));
            }
            fmt::print("\n");
        }
}
