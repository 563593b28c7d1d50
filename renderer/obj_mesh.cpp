#include "renderer/obj_mesh.h"

#include <algorithm>
#include <array>
#include <limits>
#include <unordered_map>

#include "renderer/triangulate.h"
#include "renderer/vertex_pool.h"

namespace etendue {
namespace {

struct Triangle {
    std::array<std::uint32_t, 3> corners;  // indices into ObjPolygons::corners
    std::uint32_t face;
};

/// Looks up changes for faces asked for in ascending order.
class ChangeReader {
public:
    explicit ChangeReader(const std::vector<ObjChange>& changes) : changes_(&changes) {}
    std::uint32_t at(std::uint32_t face) {
        for (; next_ < changes_->size() && (*changes_)[next_].firstFace <= face; ++next_)
            value_ = (*changes_)[next_].value;
        return value_;
    }

private:
    const std::vector<ObjChange>* changes_;
    std::size_t next_ = 0;
    std::uint32_t value_ = 0;
};

/// Also where the square of the length would be 0 or infinite.
Vec3d unitOrZero(Vec3d v) {
    const double largest = maxComponent(abs(v));
    return largest > 0 ? normalize(v / largest) : Vec3d{};
}

std::size_t index(std::int32_t i) { return static_cast<std::size_t>(i); }

class ObjMeshBuilder {
public:
    ObjMeshBuilder(const ObjPolygons& polygons, const ObjScan& scan)
        : polygons_(polygons), scan_(scan) {}

    Mesh build() {
        triangulateFaces();
        sumSmoothNormals();
        bool hasNormals = !smoothNormals_.empty();
        for (const ObjCorner& c : polygons_.corners) {
            hasNormals |= c.normal >= 0;
            hasTextureCoordinates_ |= c.textureCoordinate >= 0;
        }
        Mesh mesh;
        mesh.triangles.reserve(triangles_.size());
        mesh.materialOfTriangle.reserve(triangles_.size());
        VertexPool pool(mesh, hasNormals, hasTextureCoordinates_);
        ChangeReader materials(scan_.materials), smoothing(scan_.smoothing);
        for (const Triangle& t : triangles_) {
            std::array<Vec3, 3> normals;
            if (hasNormals) normals = shadingNormals(t, smoothing.at(t.face));
            std::array<std::uint32_t, 3>& indices = mesh.triangles.emplace_back();
            for (std::size_t i = 0; i < 3; ++i)
                indices[i] = pool.add({position(t, i), normals[i], textureCoordinate(t, i)});
            mesh.materialOfTriangle.push_back(static_cast<std::uint16_t>(materials.at(t.face)));
        }
        return mesh;
    }

    void addNotes(std::vector<std::string>& notes) const {
        const auto add = [&notes](std::size_t count, const std::string& what) {
            if (count > 0) notes.push_back(std::to_string(count) + ' ' + what);
        };
        add(degenerateTriangles_, "triangles without area left out");
        add(turnedTriangles_, "triangles wound against their normals: normals turned around");
        add(replacedNormals_, "normals of length 0 or looking to the back replaced");
        add(missingTextureCoordinates_, "corners without texture coordinates set to 0");
    }

private:
    const ObjCorner& corner(const Triangle& t, std::size_t i) const {
        return polygons_.corners[t.corners[i]];
    }
    Vec3 position(const Triangle& t, std::size_t i) const {
        return polygons_.positions[index(corner(t, i).position)];
    }
    Vec3d edge(const Triangle& t, std::size_t from, std::size_t to) const {
        return toDouble(position(t, to)) - toDouble(position(t, from));
    }
    Vec3d areaNormal(const Triangle& t) const { return cross(edge(t, 0, 1), edge(t, 0, 2)) * 0.5; }

    void triangulateFaces() {
        std::vector<Vec3> polygon;
        std::vector<std::array<std::uint32_t, 3>> pieces;
        std::uint32_t begin = 0;
        triangles_.reserve(scan_.corners - 2 * scan_.faces);
        for (std::uint32_t face = 0; face < polygons_.faceEnds.size(); ++face) {
            const std::uint32_t end = polygons_.faceEnds[face];
            polygon.clear();
            pieces.clear();
            for (std::uint32_t i = begin; i < end; ++i)
                polygon.push_back(polygons_.positions[index(polygons_.corners[i].position)]);
            triangulate(polygon, pieces);
            for (const auto& [a, b, c] : pieces) {
                const Triangle triangle{{begin + a, begin + b, begin + c}, face};
                // Lights divide by the area, in float.
                if (length(areaNormal(triangle)) >= std::numeric_limits<float>::min())
                    triangles_.push_back(triangle);
                else
                    ++degenerateTriangles_;
            }
            begin = end;
        }
    }

    static std::uint64_t smoothKey(const ObjCorner& corner, std::uint32_t group) {
        return std::uint64_t{group} << 32 | static_cast<std::uint32_t>(corner.position);
    }

    /// Only if some corner depends on them.
    void sumSmoothNormals() {
        ChangeReader smoothing(scan_.smoothing);
        if (std::ranges::none_of(triangles_, [&](const Triangle& t) {
                return smoothing.at(t.face) != 0 && !hasAllNormals(t);
            }))
            return;
        smoothing = ChangeReader(scan_.smoothing);
        for (const Triangle& t : triangles_) {
            const std::uint32_t group = smoothing.at(t.face);
            if (group == 0) continue;
            const Vec3d normal = unitOrZero(areaNormal(t));
            for (std::size_t i = 0; i < 3; ++i) {
                const Vec3d a = edge(t, i, (i + 1) % 3), b = edge(t, i, (i + 2) % 3);
                const double angle = std::atan2(length(cross(a, b)), dot(a, b));
                smoothNormals_[smoothKey(corner(t, i), group)] += normal * angle;
            }
        }
    }

    std::array<Vec3, 3> shadingNormals(const Triangle& t, std::uint32_t group) {
        const Vec3d faceNormal = unitOrZero(areaNormal(t));
        std::array<Vec3d, 3> normals;
        std::array<bool, 3> isFromFile;
        for (std::size_t i = 0; i < 3; ++i) {
            const ObjCorner& c = corner(t, i);
            isFromFile[i] = c.normal >= 0;
            if (isFromFile[i])
                normals[i] = unitOrZero(toDouble(polygons_.normals[index(c.normal)]));
            else if (group != 0)
                normals[i] = unitOrZero(smoothNormals_.at(smoothKey(c, group)));
        }
        const auto looksBack = [&](const Vec3d& n) { return dot(n, faceNormal) < 0; };
        if (hasAllNormals(t) && std::ranges::all_of(normals, looksBack)) {
            for (Vec3d& n : normals) n = -n;
            ++turnedTriangles_;
        }
        std::array<Vec3, 3> result;
        for (std::size_t i = 0; i < 3; ++i) {
            const bool isUsable = normals[i] != Vec3d{} && !looksBack(normals[i]);
            result[i] = toFloat(isUsable ? normals[i] : faceNormal);
            if (!isUsable && isFromFile[i]) ++replacedNormals_;
        }
        return result;
    }

    bool hasAllNormals(const Triangle& t) const {
        return corner(t, 0).normal >= 0 && corner(t, 1).normal >= 0 && corner(t, 2).normal >= 0;
    }

    Vec2 textureCoordinate(const Triangle& t, std::size_t i) {
        const std::int32_t k = corner(t, i).textureCoordinate;
        if (k >= 0) return polygons_.textureCoordinates[index(k)];
        if (hasTextureCoordinates_) ++missingTextureCoordinates_;
        return {};
    }

    const ObjPolygons& polygons_;
    const ObjScan& scan_;
    std::vector<Triangle> triangles_;
    std::unordered_map<std::uint64_t, Vec3d> smoothNormals_;  // not normalized, by smoothKey
    bool hasTextureCoordinates_ = false;
    std::size_t degenerateTriangles_ = 0, turnedTriangles_ = 0;
    std::size_t replacedNormals_ = 0, missingTextureCoordinates_ = 0;
};

}  // namespace

Mesh buildObjMesh(const ObjPolygons& polygons, const ObjScan& scan,
                  std::vector<std::string>& notes) {
    ObjMeshBuilder builder(polygons, scan);
    Mesh mesh = builder.build();
    mesh.materialNames = scan.materialNames;
    builder.addNotes(notes);
    return mesh;
}

}  // namespace etendue
