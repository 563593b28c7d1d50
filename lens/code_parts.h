// The parts of generated code that are the same for every lens: neutral text (code_text.h), but for
// those that name their language. Words in capitals that code_text.h does not list are replaced by
// code_generation.cpp.
#pragma once

namespace etendue {

inline constexpr const char* jetsInCPlusPlus = R"(
    /// A number and its derivatives by two variables.
    struct Jet {
        Real value, byX, byY;
        Jet() : value(0), byX(0), byY(0) {}
        Jet(Real v, Real x, Real y) : value(v), byX(x), byY(y) {}
        friend Jet operator+(Jet a, Jet b) {
            return Jet(a.value + b.value, a.byX + b.byX, a.byY + b.byY);
        }
        friend Jet operator-(Jet a, Jet b) {
            return Jet(a.value - b.value, a.byX - b.byX, a.byY - b.byY);
        }
        friend Jet operator*(Real f, Jet a) { return Jet(f * a.value, f * a.byX, f * a.byY); }
        Jet& operator+=(Jet a) { return *this = *this + a; }
    };

    static Real sqrt(Real a) { return std::sqrt(a); }
    static Real abs(Real a) { return std::abs(a); }
)";

/// After jets, for both languages.
inline constexpr const char* sharedFunctions = R"(
FUNCTION JET @still(REAL a) { return JET(a, 0.0, 0.0); }

FUNCTION JET @product(JET a, JET b) {
    return JET(a.VALUE * b.VALUE, a.VALUE * b.BYX + b.VALUE * a.BYX,
               a.VALUE * b.BYY + b.VALUE * a.BYY);
}

FUNCTION JET @inverse(JET a) {
    REAL i = 1.0 / a.VALUE;
    return JET(i, -i * i * a.BYX, -i * i * a.BYY);
}

FUNCTION JET @root(JET a) {
    REAL r = sqrt(a.VALUE);
    REAL slope = 0.5 / r;
    return JET(r, slope * a.BYX, slope * a.BYY);
}

/// A ray at the sphere of the first surface: its point, projected along the axis, and its direction
/// in the tangent frame that the smallest rotation carries from +z to the sphere's normal. The
/// derivatives are those by the sensor point, the aperture point held fixed.
struct @PupilState {
    JET x, y, directionX, directionY;
    REAL throughput;
};

struct @SceneRay {
    bool passes;
    JET x, y, z, directionX, directionY, directionZ;
    REAL throughput;
};
)";

/// From the pupil sphere to lens space; CURVATURE is replaced.
inline constexpr const char* toLensSpace = R"(
FUNCTION @SceneRay @toLensSpace(@PupilState pupil) {
    @SceneRay ray;
    ray.passes = false;
    ray.throughput = pupil.throughput;
    REAL curvature = CURVATURE;
    JET u = pupil.directionX;
    JET v = pupil.directionY;
    JET squared = @product(pupil.x, pupil.x) + @product(pupil.y, pupil.y);
    JET radicand = @still(1.0) - curvature * curvature * squared;
    JET along = @still(1.0) - @product(u, u) - @product(v, v);
    // Beyond the sphere's equator or a direction longer than 1 there is no ray.
    if (!(radicand.VALUE > 0.0 && along.VALUE >= 0.0 && pupil.throughput > 0.0)) return ray;
    JET normalX = -curvature * pupil.x;
    JET normalY = -curvature * pupil.y;
    JET normalZ = @root(radicand);
    JET share = @inverse(@still(1.0) + normalZ);
    ray.x = pupil.x;
    ray.y = pupil.y;
    ray.z = curvature * @product(squared, share);
    JET outward = @root(along);
    JET across = @product(@product(normalX, u) + @product(normalY, v), share);
    ray.directionX = u + @product(normalX, outward - across);
    ray.directionY = v + @product(normalY, outward - across);
    ray.directionZ = @product(normalZ, outward) - @product(normalX, u) - @product(normalY, v);
    // Negative where the map has turned over: there two sensor points see one direction.
    REAL turnX = ray.directionY.BYX * ray.directionZ.BYY - ray.directionZ.BYX * ray.directionY.BYY;
    REAL turnY = ray.directionZ.BYX * ray.directionX.BYY - ray.directionX.BYX * ray.directionZ.BYY;
    REAL turnZ = ray.directionX.BYX * ray.directionY.BYY - ray.directionY.BYX * ray.directionX.BYY;
    ray.passes = ray.directionX.VALUE * turnX + ray.directionY.VALUE * turnY +
                 ray.directionZ.VALUE * turnZ > 0.0;
    return ray;
}
)";

inline constexpr const char* twoPointSceneRay = R"(
FUNCTION @SceneRay @sceneRay(REAL sx, REAL sy, REAL ax, REAL ay, REAL nm) {
    @SceneRay none;
    none.passes = false;
    none.throughput = 0.0;
    if (!(@isInDomain(sx, sy, ax, ay, nm) && @passesRims(sx, sy, ax, ay, nm))) return none;
    return @toLensSpace(@pupilState(JET(sx, 1.0, 0.0), JET(sy, 0.0, 1.0), APERTURE_POINT, nm));
}
)";

/// GUESS_X, GUESS_Y, TOLERANCE are replaced.
inline constexpr const char* sensorStateSceneRay = R"(
/// The slope whose ray crosses the aperture at (ax, ay) by Newton's method, and how it moves with
/// the sensor point.
struct @Slope {
    bool found;
    JET x, y;
    REAL determinant;  // of the aperture point by the slope
};

FUNCTION @Slope @slopeThrough(REAL sx, REAL sy, REAL ax, REAL ay, REAL nm) {
    @Slope slope;
    slope.found = false;
    slope.determinant = 0.0;
    REAL qx = GUESS_X;
    REAL qy = GUESS_Y;
    REAL miss = 2.0 * TOLERANCE;
    for (int i = 0; i < 20; i++) {
        @AperturePoint at = @aperturePoint(@still(sx), @still(sy), JET(qx, 1.0, 0.0), JET(qy, 0.0, 1.0), nm);
        REAL determinant = at.x.BYX * at.y.BYY - at.x.BYY * at.y.BYX;
        if (!(determinant > 0.0)) return slope;
        if (miss <= TOLERANCE) {
            @AperturePoint bySensor = @aperturePoint(JET(sx, 1.0, 0.0), JET(sy, 0.0, 1.0), @still(qx), @still(qy), nm);
            slope.found = true;
            slope.determinant = determinant;
            slope.x = JET(qx, (at.x.BYY * bySensor.y.BYX - at.y.BYY * bySensor.x.BYX) / determinant,
                          (at.x.BYY * bySensor.y.BYY - at.y.BYY * bySensor.x.BYY) / determinant);
            slope.y = JET(qy, (at.y.BYX * bySensor.x.BYX - at.x.BYX * bySensor.y.BYX) / determinant,
                          (at.y.BYX * bySensor.x.BYY - at.x.BYX * bySensor.y.BYY) / determinant);
            return slope;
        }
        REAL missX = ax - at.x.VALUE;
        REAL missY = ay - at.y.VALUE;
        miss = abs(missX) + abs(missY);
        qx += (at.y.BYY * missX - at.x.BYY * missY) / determinant;
        qy += (at.x.BYX * missY - at.y.BYX * missX) / determinant;
    }
    return slope;
}

FUNCTION @SceneRay @sceneRay(REAL sx, REAL sy, REAL ax, REAL ay, REAL nm) {
    @SceneRay none;
    none.passes = false;
    none.throughput = 0.0;
    if (!(@isInDomain(sx, sy, ax, ay, nm) && @passesRims(sx, sy, ax, ay, nm))) return none;
    @Slope slope = @slopeThrough(sx, sy, ax, ay, nm);
    if (!slope.found) return none;
    @PupilState pupil = @pupilState(JET(sx, 1.0, 0.0), JET(sy, 0.0, 1.0), slope.x, slope.y, nm);
    REAL squared = 1.0 + slope.x.VALUE * slope.x.VALUE + slope.y.VALUE * slope.y.VALUE;
    pupil.throughput *= 1.0 / (squared * squared * slope.determinant);
    return @toLensSpace(pupil);
}
)";

inline constexpr const char* traceInCPlusPlus = R"(
template <class Real>
std::optional<typename NAME<Real>::Ray> NAME<Real>::trace(const Real (&sensorMm)[2],
                                                          const Real (&apertureMm)[2],
                                                          Real wavelengthNm) {
    const SceneRay found =
        sceneRay(sensorMm[0], sensorMm[1], apertureMm[0], apertureMm[1], wavelengthNm);
    if (!found.passes) return {};
    Ray ray;
    const Jet origin[] = {found.x, found.y, found.z};
    const Jet direction[] = {found.directionX, found.directionY, found.directionZ};
    for (int i = 0; i < 3; ++i) {
        ray.origin[i] = origin[i].value;
        ray.originBySensor[i][0] = origin[i].byX;
        ray.originBySensor[i][1] = origin[i].byY;
        ray.direction[i] = direction[i].value;
        ray.directionBySensor[i][0] = direction[i].byX;
        ray.directionBySensor[i][1] = direction[i].byY;
    }
    ray.throughput = found.throughput;
    return ray;
}
)";

inline constexpr const char* traceInGlsl = R"(
@Ray @trace(vec2 sensorMm, vec2 apertureMm, float wavelengthNm) {
    @SceneRay found = @sceneRay(sensorMm.x, sensorMm.y, apertureMm.x, apertureMm.y, wavelengthNm);
    @Ray ray;
    ray.passes = found.passes;
    ray.origin = vec3(found.x.x, found.y.x, found.z.x);
    ray.direction = vec3(found.directionX.x, found.directionY.x, found.directionZ.x);
    ray.originBySensor = mat2x3(vec3(found.x.y, found.y.y, found.z.y),
                                vec3(found.x.z, found.y.z, found.z.z));
    ray.directionBySensor =
        mat2x3(vec3(found.directionX.y, found.directionY.y, found.directionZ.y),
               vec3(found.directionX.z, found.directionY.z, found.directionZ.z));
    ray.throughput = found.throughput;
    return ray;
}
)";

}  // namespace etendue
