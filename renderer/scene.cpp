#include "renderer/scene.h"

#include <map>

namespace etendue {

namespace {

/// Ready for the renderer: in world space, the front side still the front.
void moveToWorld(Mesh& mesh, const Transform& worldFromMesh) {
    if (worldFromMesh == Transform{}) return;
    const bool isMirrored = worldFromMesh.determinant() < 0.0;
    for (Vec3& p : mesh.positions) p = toFloat(worldFromMesh.point(toDouble(p)));
    for (Vec3& n : mesh.normals) {
        const Vec3d mapped = normalize(worldFromMesh.normal(toDouble(n)));
        n = toFloat(isMirrored ? -mapped : mapped);
    }
    if (isMirrored)
        for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
}

std::vector<Instance> makeInstances(std::vector<Mesh>& meshes, std::vector<Placement> placements) {
    std::vector<int> uses(meshes.size());
    for (const Placement& p : placements) ++uses[p.mesh];
    std::vector<Instance> instances;
    for (Placement& p : placements) {
        Instance instance;
        instance.mesh = p.mesh;
        instance.materials = std::move(p.materials);
        if (uses[p.mesh] == 1) {
            moveToWorld(meshes[p.mesh], p.worldFromMesh);
        } else if (p.worldFromMesh != Transform{}) {
            instance.isInWorldSpace = false;
            instance.worldFromMesh = p.worldFromMesh;
            instance.meshFromWorld = p.worldFromMesh.inverse();
        }
        instances.push_back(std::move(instance));
    }
    return instances;
}

template <class Visit>
void forEachVertex(const std::vector<Mesh>& meshes, const std::vector<Instance>& instances,
                   const Visit& visit) {
    for (const Instance& instance : instances)
        for (const Vec3& p : meshes[instance.mesh].positions)
            visit(instance.isInWorldSpace ? toDouble(p)
                                          : instance.worldFromMesh.point(toDouble(p)));
}

/// The smallest sphere around the centre of the bounding box. An empty scene gets a unit sphere:
/// lights at infinity still need somewhere to emit from.
BoundingSphere boundsOf(const std::vector<Mesh>& meshes, const std::vector<Instance>& instances) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    Vec3d low{infinity, infinity, infinity}, high = -low;
    forEachVertex(meshes, instances, [&](Vec3d p) {
        low = min(low, p);
        high = max(high, p);
    });
    if (!(low.x <= high.x)) return {{}, 1.0f};
    const Vec3 center = toFloat((low + high) * 0.5);
    double radiusSquared = 0.0;
    forEachVertex(meshes, instances, [&](Vec3d p) {
        radiusSquared = std::max(radiusSquared, lengthSquared(p - toDouble(center)));
    });
    // Rounded up, so that nothing sticks out.
    return {center, static_cast<float>(std::max(std::sqrt(radiusSquared) * 1.000001, 1e-30))};
}

EmissiveTriangle worldTriangle(const Mesh& mesh, const Instance& instance, std::size_t triangle) {
    std::array<Vec3, 3> corner;
    for (std::size_t i = 0; i < 3; ++i)
        corner[i] = toFloat(
            instance.worldFromMesh.point(toDouble(mesh.positions[mesh.triangles[triangle][i]])));
    if (instance.worldFromMesh.determinant() < 0.0) std::swap(corner[1], corner[2]);
    return {corner[0], corner[1], corner[2]};
}

bool hasArea(const EmissiveTriangle& t) {
    return lengthSquared(cross(toDouble(t.b) - toDouble(t.a), toDouble(t.c) - toDouble(t.a))) > 0.0;
}

/// One light for the triangles of an instance that share an emissive material.
void addAreaLights(const std::vector<Mesh>& meshes, Instance& instance,
                   std::vector<std::unique_ptr<Light>>& lights) {
    const Mesh& mesh = meshes[instance.mesh];
    std::map<const Material*, std::vector<std::size_t>> emissive;  // triangles by material
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const Material* material = instance.materials[mesh.materialOfTriangle[t]];
        if (emits(*material)) emissive[material].push_back(t);
    }
    if (emissive.empty()) return;
    instance.lightOfTriangle.assign(mesh.triangles.size(), -1);
    // By slot, not by address: the order of the lights must not depend on where memory was found.
    for (const Material* material : instance.materials) {
        const auto found = emissive.find(material);
        if (found == emissive.end()) continue;
        std::vector<EmissiveTriangle> triangles;
        for (const std::size_t t : found->second) {
            const EmissiveTriangle triangle = worldTriangle(mesh, instance, t);
            if (!hasArea(triangle)) continue;
            triangles.push_back(triangle);
            instance.lightOfTriangle[t] = static_cast<std::int32_t>(lights.size());
        }
        if (!triangles.empty())
            lights.push_back(makeAreaLight(std::move(triangles), material->emission,
                                           material->isEmissionTwoSided));
        emissive.erase(found);
    }
}

std::vector<std::unique_ptr<Light>> makeLights(const SceneParts& parts,
                                               const std::vector<Mesh>& meshes,
                                               std::vector<Instance>& instances,
                                               BoundingSphere bounds) {
    std::vector<std::unique_ptr<Light>> lights;
    for (Instance& instance : instances) addAreaLights(meshes, instance, lights);
    for (const auto& make : parts.lights) lights.push_back(make(bounds));
    return lights;
}

}  // namespace

Scene::Scene(SceneParts parts, int threads)
    : meshes_(std::move(parts.meshes)),
      materials_(std::move(parts.materials)),
      instances_(makeInstances(meshes_, std::move(parts.placements))),
      bounds_(boundsOf(meshes_, instances_)),
      lights_(makeLights(parts, meshes_, instances_, bounds_)),
      intersector_(std::make_unique<Intersector>(meshes_, instances_, threads)) {}

std::optional<SurfacePoint> Scene::closestHit(const Ray& ray) const {
    const std::optional<RayHit> hit = intersector_->closestHit(ray);
    if (!hit) return std::nullopt;
    const Instance& instance = instances_[hit->instance];
    return std::optional<SurfacePoint>(std::in_place, meshes_[instance.mesh], instance, *hit);
}

bool Scene::isVisible(Vec3 from, Vec3 to) const {
    // A direction that is not unit ends the ray at the other point exactly, at distance 1.
    return !intersector_->isOccluded({from, to - from, 1.0f});
}

bool Scene::isVisibleToInfinity(Vec3 from, Vec3 direction) const {
    return !intersector_->isOccluded({from, direction});
}

std::size_t Scene::triangleCount() const {
    std::size_t count = 0;
    for (const Instance& i : instances_) count += meshes_[i.mesh].triangles.size();
    return count;
}

}  // namespace etendue
