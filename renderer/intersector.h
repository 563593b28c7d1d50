// Intersector: rays against all instances of all meshes. Embree is known to intersector.cpp alone.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "renderer/mesh.h"
#include "renderer/surface_point.h"
#include "renderer/texture.h"
#include "renderer/transform.h"

namespace etendue {

/// One placement of a mesh. A mesh placed once is moved to world space while loading, and its
/// instance has the identity here: no transform is paid for per ray.
struct Instance {
    std::uint32_t mesh = 0;
    bool isInWorldSpace = true;  // both transforms are the identity
    Transform worldFromMesh, meshFromWorld;
    std::vector<const Material*> materials;     // by the mesh's material index
    std::vector<std::int32_t> lightOfTriangle;  // light index or -1; empty: none of them emits
};

struct RayHit {
    std::uint32_t instance, triangle;
    float b1, b2;    // barycentric coordinates of the second and third vertex
    float distance;  // along the ray, in lengths of its direction
};

class Intersector {
public:
    /// Keeps references: meshes and instances must outlive it and stay where they are.
    /// Throws std::runtime_error if Embree refuses (out of memory, an unsupported processor).
    Intersector(std::span<const Mesh> meshes, std::span<const Instance> instances, int threads);
    ~Intersector();
    Intersector(const Intersector&) = delete;
    Intersector& operator=(const Intersector&) = delete;

    std::optional<RayHit> closestHit(const Ray& ray) const;
    /// True if anything lies on the ray between its origin and maxDistance.
    bool isOccluded(const Ray& ray) const;

    /// Rays that were not traced because they were not finite or beyond ±1e18, in the world or in
    /// the space of an instance's mesh: each is a defect, but for instances that shrink their mesh
    /// so much that rays from so far cannot be followed there.
    std::uint64_t refusedRays() const { return refusedRays_; }

private:
    struct Embree;
    std::unique_ptr<Embree> embree_;
    mutable std::atomic<std::uint64_t> refusedRays_{0};
};

}  // namespace etendue
