// Scene: what the estimators see. Built once by the loader, then read only.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/intersector.h"
#include "renderer/light.h"
#include "renderer/light_table.h"
#include "renderer/material.h"
#include "renderer/mesh.h"
#include "renderer/surface_point.h"

namespace etendue {

/// A mesh where it stands, before lights and acceleration structure exist.
struct Placement {
    std::uint32_t mesh = 0;
    Transform worldFromMesh;
    std::vector<const Material*> materials;  // by the mesh's material index
};

/// Everything that a scene file names, in the order of the file.
struct SceneParts {
    std::vector<Mesh> meshes;
    std::vector<std::unique_ptr<Material>> materials;
    std::vector<Placement> placements;
    /// Made after the geometry, because lights at infinity need its bounds.
    std::vector<std::function<std::unique_ptr<Light>(BoundingSphere)>> lights;
};

class Scene {
public:
    /// Moves meshes that are placed once to world space, makes the emissive triangles lights and
    /// builds the intersector. Throws std::runtime_error if Embree refuses.
    Scene(SceneParts parts, int threads);

    std::optional<SurfacePoint> closestHit(const Ray& ray) const;
    /// Nothing between the two points, each already off its surface (offsetOrigin).
    bool isVisible(Vec3 from, Vec3 to) const;
    /// Nothing from the point on.
    bool isVisibleToInfinity(Vec3 from, Vec3 direction) const;

    const LightTable& lights() const { return lights_; }
    BoundingSphere bounds() const { return bounds_; }
    std::size_t triangleCount() const;  // of all placements
    std::uint64_t refusedRays() const { return intersector_->refusedRays(); }
    const Intersector& intersector() const { return *intersector_; }

private:
    std::vector<Mesh> meshes_;
    std::vector<std::unique_ptr<Material>> materials_;
    std::vector<Instance> instances_;
    BoundingSphere bounds_;
    LightTable lights_;
    std::unique_ptr<Intersector> intersector_;
};

}  // namespace etendue
