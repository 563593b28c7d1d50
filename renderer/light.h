// Light: a source that can be sampled from a receiver (next-event estimation) and can emit a ray
// (light tracing), each with the densities that the other one needs for multiple importance
// sampling.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "renderer/mesh.h"
#include "renderer/spectrum.h"
#include "renderer/texture.h"
#include "renderer/transform.h"
#include "renderer/vec.h"

namespace etendue {

/// A sphere around everything a ray can meet; lights at infinity emit from a disc of its radius.
struct BoundingSphere {
    Vec3 center;
    float radius = 0.0f;  // metres; positive
};

/// A light as a receiver meets it.
struct EmitterHit {
    Vec3 direction;  // unit, from the receiver to the light
    float distance;  // metres; infinite for a light at infinity
    Vec3 normal;     // unit, geometric, front side; unused where the light has no surface
};

struct LightSample {
    Vec3 direction;      // unit, from the receiver to the light
    float distance;      // metres; infinite for a light at infinity
    Vec3 position;       // on the light; for a light at infinity unused
    Vec3 positionError;  // as SurfacePoint's
    Vec3 normal;         // as EmitterHit's
    Spectrum radiance;   // arriving at an unoccluded receiver. A Dirac light: irradiance on a
                         // receiver that faces it
    float pdfSolidAngle = 0.0f;  // at the receiver; 1 for a Dirac light
    bool isDirac = false;        // no ray can find this light by chance
};

/// Densities with which emit() draws a ray. A Dirac factor counts as 1.
struct EmissionPdf {
    float pdfArea =
        0.0f;  // 1/m², of the origin; lights at infinity: on the disc across the direction
    float pdfSolidAngle = 0.0f;  // 1/sr, of the direction
};

struct EmittedRay {
    Vec3 origin;
    Vec3 originError;  // as SurfacePoint's; zero where there is no surface
    Vec3 normal;  // unit, at the origin, on the side that emits; the direction itself where there
                  // is no surface
    Vec3 direction;     // unit
    Spectrum radiance;  // along the ray. A Dirac light: W/sr (point, spot) or W/m² (directional)
    float cosTheta = 1.0f;  // between direction and normal; radiance · cosTheta / (pdfArea ·
                            // pdfSolidAngle) is the path's throughput
    EmissionPdf pdf;
    bool isDiracPosition = false, isDiracDirection = false;
};

class Light {
public:
    virtual ~Light() = default;

    /// Emitted flux in W (mean of the lanes), or an estimate of it: lights are chosen by it.
    virtual float power() const = 0;

    /// Empty when the light cannot be seen from there (its dark side, outside the spot's cone), and
    /// from so near or so far that floats cannot hold the density or the result.
    virtual std::optional<LightSample> sample(Vec3 receiver, Vec2 u) const = 0;

    /// Radiance towards the receiver from where a ray met the light; zero for a Dirac light.
    virtual Spectrum radiance(const EmitterHit&) const = 0;

    /// The density with which sample() draws that direction, 1/sr at the receiver; zero for a Dirac
    /// light.
    virtual float pdfSolidAngle(const EmitterHit&) const = 0;

    /// A ray that carries the light's flux. Empty where the sample lands on nothing.
    virtual std::optional<EmittedRay> emit(Vec2 uPosition, Vec2 uDirection) const = 0;

    /// The densities with which emit() draws the ray that leaves the light against `hit.direction`.
    virtual EmissionPdf emissionPdf(const EmitterHit&) const = 0;

    /// True for environment, constant and directional lights.
    virtual bool isInfinite() const = 0;
};

// The lights, one .cpp each. Positions and directions are in world space.

/// Triangles in world space that share one emitted radiance. `normals` are not needed: emission
/// follows the winding. Triangles of no area are never chosen. At least one must have area.
struct EmissiveTriangle {
    Vec3 a, b, c;
};
std::unique_ptr<Light> makeAreaLight(std::vector<EmissiveTriangle> triangles, Spectrum radiance,
                                     bool isTwoSided);

/// Uniform radiance from all directions.
std::unique_ptr<Light> makeConstantLight(Spectrum radiance, BoundingSphere scene);

/// Latitude-longitude image, importance-sampled. `worldFromLight` is a rotation; in the light's
/// space the image's centre column lies towards +z, its top row towards +y and its right half
/// towards −x: to the right of an upright viewer inside (see environment_light.cpp). Throws
/// InputError for negative texels.
std::unique_ptr<Light> makeEnvironmentLight(std::shared_ptr<const Texture> image, float scale,
                                            const Transform& worldFromLight, BoundingSphere scene);

/// `intensity` in W/sr.
std::unique_ptr<Light> makePointLight(Vec3 position, Spectrum intensity);

/// `intensity` in W/sr along `direction` (unit), constant up to the inner half angle, falling
/// smoothly to zero at the outer one.
std::unique_ptr<Light> makeSpotLight(Vec3 position, Vec3 direction, Spectrum intensity,
                                     float innerHalfAngleDegrees, float outerHalfAngleDegrees);

/// `irradiance` in W/m² on a surface across `direction`, the unit direction in which the light
/// travels.
std::unique_ptr<Light> makeDirectionalLight(Vec3 direction, Spectrum irradiance,
                                            BoundingSphere scene);

}  // namespace etendue
