#include "renderer/intersector.h"

#include <embree3/rtcore.h>

#include <bit>
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>

#include "renderer/lanes.h"
#include "renderer/material.h"
#include "renderer/parallel.h"

namespace etendue {

namespace {

constexpr float largestCoordinate = 1e18f;  // beyond 1.8e18 Embree aborts the process

/// Of rays that stay within largestCoordinate in the space of each instance's mesh, too.
float farthestReach(std::span<const Instance> instances) {
    double reach = double{largestCoordinate};
    for (const Instance& instance : instances) {
        if (instance.isInWorldSpace) continue;
        // Of three coordinates, and of the translation, that add up.
        const Transform& t = instance.meshFromWorld;
        const Vec3d sums = abs(t.x) + abs(t.y) + abs(t.z);
        reach = std::min(reach, double{largestCoordinate} / maxComponent(sums) -
                                    maxComponent(abs(instance.worldFromMesh.translation)));
    }
    return static_cast<float>(reach);
}

/// Fills `out`; false if Embree must not see it.
bool setRay(RTCRay& out, const Ray& ray, float reach) {
    const FloatLanes origin = lanesOf(ray.origin), direction = lanesOf(ray.direction);
    // Written so that NaN fails.
    const auto isInside = [reach](FloatLanes v) { return (v >= -reach) & (v <= reach); };
    const IntLanes inside = isInside(origin) & isInside(direction);
    if (!(inside[0] & inside[1] & inside[2]) || ray.direction == Vec3{} ||
        !(ray.maxDistance >= 0.0f))
        return false;
    // The fourth lanes are tnear, 0 since origins are offset by their error bound instead, and
    // time.
    static_assert(offsetof(RTCRay, tnear) == offsetof(RTCRay, org_x) + 3 * sizeof(float) &&
                  offsetof(RTCRay, time) == offsetof(RTCRay, dir_x) + 3 * sizeof(float));
    std::memcpy(&out.org_x, &origin, sizeof origin);
    std::memcpy(&out.dir_x, &direction, sizeof direction);
    out.tfar = ray.maxDistance;
    out.mask = ~0u;
    out.id = 0;
    out.flags = 0;
    return true;
}

std::uint32_t mix(std::uint32_t h, std::uint32_t value) {
    h = (h ^ value) * 0x9E3779B1u;
    return h ^ (h >> 15);
}

/// A number in [0, 1) that depends on the ray and the triangle alone, so that opacity needs no
/// random numbers and the bits are the same in any order of traversal.
float existenceThreshold(const RTCFilterFunctionNArguments* args, std::uint32_t instance,
                         std::uint32_t triangle) {
    std::uint32_t h = mix(mix(0x85EBCA6Bu, instance), triangle);
    const float coordinates[6] = {RTCRayN_org_x(args->ray, 1, 0), RTCRayN_org_y(args->ray, 1, 0),
                                  RTCRayN_org_z(args->ray, 1, 0), RTCRayN_dir_x(args->ray, 1, 0),
                                  RTCRayN_dir_y(args->ray, 1, 0), RTCRayN_dir_z(args->ray, 1, 0)};
    for (const float c : coordinates) h = mix(h, std::bit_cast<std::uint32_t>(c));
    h = mix(h, h >> 16);
    return static_cast<float>(h >> 8) * 0x1p-24f;
}

}  // namespace

struct Intersector::Embree {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::vector<RTCScene> meshScenes;  // one for each mesh that is placed more than once, else null
    std::span<const Mesh> meshes;
    std::span<const Instance> instances;
    float reach = 0.0f;
    std::string lastError;  // in Embree's own words

    ~Embree() {
        for (const RTCScene s : meshScenes)
            if (s) rtcReleaseScene(s);
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    void throwOnError(const char* doing) const {
        const RTCError error = rtcGetDeviceError(device);
        if (error == RTC_ERROR_NONE) return;
        const std::string reason = error == RTC_ERROR_OUT_OF_MEMORY     ? "out of memory"
                                   : error == RTC_ERROR_UNSUPPORTED_CPU ? "processor not supported"
                                   : lastError.empty()                  ? "internal error"
                                                                        : inPlainWords(lastError);
        throw std::runtime_error("Embree: " + reason + " while " + doing);
    }

    void start(const std::string& settings) {
        device = rtcNewDevice(settings.c_str());
        throwOnError("starting");
        const auto keep = [](void* words, RTCError, const char* text) {
            *static_cast<std::string*>(words) = text;
        };
        rtcSetDeviceErrorFunction(device, keep, &lastError);
    }

    /// Opacity as existence: with probability 1 − opacity the triangle is not there for this ray.
    /// The probability of a path and its contribution share that factor, so it cancels in every
    /// estimator.
    static void filter(const RTCFilterFunctionNArguments* args) {
        if (args->valid[0] == 0) return;
        const auto& self = *static_cast<const Embree*>(args->geometryUserPtr);
        const std::uint32_t outer = RTCHitN_instID(args->hit, 1, 0, 0);
        const std::uint32_t index =
            outer != RTC_INVALID_GEOMETRY_ID ? outer : RTCHitN_geomID(args->hit, 1, 0);
        const std::uint32_t triangle = RTCHitN_primID(args->hit, 1, 0);
        const Instance& instance = self.instances[index];
        const Mesh& mesh = self.meshes[instance.mesh];
        const Material& material = *instance.materials[mesh.materialOfTriangle[triangle]];
        if (!material.opacity) return;
        Vec2 uv{};
        if (!mesh.textureCoordinates.empty()) {
            const auto& corner = mesh.triangles[triangle];
            const float b1 = RTCHitN_u(args->hit, 1, 0), b2 = RTCHitN_v(args->hit, 1, 0);
            uv = mesh.textureCoordinates[corner[0]] * (1 - b1 - b2) +
                 mesh.textureCoordinates[corner[1]] * b1 + mesh.textureCoordinates[corner[2]] * b2;
        }
        const bool exists =
            existenceThreshold(args, index, triangle) < material.opacity->scalar(uv);
        if (!exists) args->valid[0] = 0;
    }

    bool hasOpacity(std::uint32_t mesh) const {
        for (const Instance& i : instances)
            if (i.mesh == mesh)
                for (const Material* m : i.materials)
                    if (m->opacity) return true;
        return false;
    }

    RTCGeometry makeTriangles(std::uint32_t meshIndex) {
        const Mesh& mesh = meshes[meshIndex];
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        void* positions =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                    sizeof(Vec3), mesh.positions.size());
        void* triangles =
            rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                    sizeof(mesh.triangles[0]), mesh.triangles.size());
        throwOnError("allocating a mesh");
        std::memcpy(positions, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
        std::memcpy(triangles, mesh.triangles.data(),
                    mesh.triangles.size() * sizeof(mesh.triangles[0]));
        if (hasOpacity(meshIndex)) {
            rtcSetGeometryUserData(geometry, this);
            rtcSetGeometryIntersectFilterFunction(geometry, filter);
            rtcSetGeometryOccludedFilterFunction(geometry, filter);
        }
        rtcCommitGeometry(geometry);
        return geometry;
    }

    RTCScene commitNewScene(std::span<const std::pair<RTCGeometry, std::uint32_t>> geometries) {
        const RTCScene s = rtcNewScene(device);
        rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_HIGH);
        for (const auto& [geometry, id] : geometries) {
            rtcAttachGeometryByID(s, geometry, id);
            rtcReleaseGeometry(geometry);
        }
        rtcCommitScene(s);
        throwOnError("building the scene");
        return s;
    }

    RTCGeometry makeInstance(const Instance& instance) {
        RTCScene& meshScene = meshScenes[instance.mesh];
        if (!meshScene) {
            const std::pair<RTCGeometry, std::uint32_t> only{makeTriangles(instance.mesh), 0u};
            meshScene = commitNewScene({&only, 1});
        }
        const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(geometry, meshScene);
        const Transform& t = instance.worldFromMesh;
        float columns[12];
        int next = 0;
        for (const Vec3d& column : {t.x, t.y, t.z, t.translation})
            for (int axis = 0; axis < 3; ++axis) columns[next++] = static_cast<float>(column[axis]);
        rtcSetGeometryTransform(geometry, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(geometry);
        return geometry;
    }
};

Intersector::Intersector(std::span<const Mesh> meshes, std::span<const Instance> instances,
                         int threads)
    : embree_(std::make_unique<Embree>()) {
#if defined(ETENDUE_STD_THREADS)
    threads = 1;  // the thread sanitizer does not see how Embree's own threads synchronise
#endif
    // The instruction set is pinned so that two machines find the same hits, bit for bit.
    std::string settings = "threads=" + std::to_string(threads);
#if defined(__x86_64__)
    settings += ",isa=avx2";
#endif
    embree_->start(settings);
    embree_->meshes = meshes;
    embree_->instances = instances;
    embree_->reach = farthestReach(instances);
    embree_->meshScenes.resize(meshes.size());
    std::vector<std::pair<RTCGeometry, std::uint32_t>> geometries;
    for (std::uint32_t i = 0; i < instances.size(); ++i) {
        geometries.emplace_back(instances[i].isInWorldSpace
                                    ? embree_->makeTriangles(instances[i].mesh)
                                    : embree_->makeInstance(instances[i]),
                                i);
    }
    embree_->scene = embree_->commitNewScene(geometries);
}

Intersector::~Intersector() = default;

std::optional<RayHit> Intersector::closestHit(const Ray& ray) const {
    RTCRayHit query;
    if (!setRay(query.ray, ray, embree_->reach)) {
        ++refusedRays_;
        return std::nullopt;
    }
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    query.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(embree_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    // On triangles of extreme proportions Embree may report a hit without a place.
    if (!std::isfinite(query.hit.u) || !std::isfinite(query.hit.v) ||
        !std::isfinite(query.ray.tfar)) {
        ++refusedRays_;
        return std::nullopt;
    }
    const bool isInstanced = query.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
    return RayHit{isInstanced ? query.hit.instID[0] : query.hit.geomID, query.hit.primID,
                  query.hit.u, query.hit.v, query.ray.tfar};
}

bool Intersector::isOccluded(const Ray& ray) const {
    RTCRay query;
    if (!setRay(query, ray, embree_->reach)) {
        ++refusedRays_;
        return true;
    }
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcOccluded1(embree_->scene, &context, &query);
    return query.tfar < 0.0f;
}

}  // namespace etendue
