#include "lens/paraxial.h"

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace etendue {

namespace {

/// Maps (height, slope dy/dz) to (height, slope), light travelling toward the scene.
using RayMatrix = Eigen::Matrix2d;

RayMatrix propagation(double distanceMm) {
    RayMatrix matrix;
    matrix << 1.0, distanceMm, 0.0, 1.0;
    return matrix;
}

RayMatrix refraction(double curvature, double from, double to) {
    RayMatrix matrix;
    matrix << 1.0, 0.0, -(to - from) * curvature / to, from / to;
    return matrix;
}

enum class Plane { xz, yz };

/// A system at one wavelength, seen in one plane.
struct Section {
    const OpticalSystem& system;
    std::vector<double> indices;
    Plane plane;

    double curvature(std::size_t i) const {
        const SurfaceShape& shape = system.surfaces[i].shape;
        return (plane == Plane::xz ? shape.curvedInX : shape.curvedInY) ? shape.curvature : 0.0;
    }
    RayMatrix refractionAt(std::size_t i) const {
        return refraction(curvature(i), indices[i + 1], indices[i]);
    }
    /// From behind surface `end` − 1 to in front of surface `begin`.
    RayMatrix matrix(std::size_t begin, std::size_t end) const {
        RayMatrix result = RayMatrix::Identity();
        for (std::size_t i = end; i-- > begin;) {
            result = refractionAt(i) * result;
            if (i > begin)
                result =
                    propagation(system.surfaces[i - 1].vertexZMm - system.surfaces[i].vertexZMm) *
                    result;
        }
        return result;
    }
    /// From the last vertex, in air, to the stop.
    RayMatrix rear() const {
        const std::size_t stop = system.stop, count = system.surfaces.size();
        if (stop + 1 == count) return RayMatrix::Identity();
        const double gap = system.surfaces[stop].vertexZMm - system.surfaces[stop + 1].vertexZMm;
        return propagation(gap) * matrix(stop + 1, count);
    }
    /// From the stop to the first vertex, in air.
    RayMatrix front() const {
        const std::size_t stop = system.stop;
        if (stop == 0) return RayMatrix::Identity();
        const double gap = system.surfaces[stop - 1].vertexZMm - system.surfaces[stop].vertexZMm;
        return matrix(0, stop) * propagation(gap);
    }
};

ParaxialAxis axisData(const Section& section) {
    const double lastZ = section.system.surfaces.back().vertexZMm;
    const RayMatrix whole = section.matrix(0, section.system.surfaces.size());
    const RayMatrix front = section.front(), rear = section.rear();
    ParaxialAxis axis;
    axis.focalLengthMm = -1.0 / whole(1, 0);
    axis.backFocalDistanceMm = -whole(1, 1) / whole(1, 0);
    axis.frontFocalDistanceMm = -whole(0, 0) / whole(1, 0);
    axis.frontPrincipalZMm = axis.frontFocalDistanceMm - axis.focalLengthMm;
    axis.rearPrincipalZMm = lastZ - axis.backFocalDistanceMm + axis.focalLengthMm;
    // Rays from the axial point of the stop cross the axis there; those from a point off it meet
    // there too.
    axis.entrancePupilZMm = -front(0, 1) / front(1, 1);
    axis.entrancePupilPerStop = front.determinant() / front(1, 1);
    axis.exitPupilZMm = lastZ + rear(0, 1) / rear(0, 0);
    axis.exitPupilPerStop = 1.0 / rear(0, 0);
    return axis;
}

/// The sharp image, behind the last vertex, by Newton's equation x x′ = f².
double imageDistance(const ParaxialAxis& axis, double lastVertexZMm, double objectDistanceMm) {
    if (objectDistanceMm == std::numeric_limits<double>::infinity())
        return axis.backFocalDistanceMm;
    const double betweenFoci = axis.frontFocalDistanceMm - lastVertexZMm + axis.backFocalDistanceMm;
    const double sum = objectDistanceMm - betweenFoci;  // x + x′
    const double f = axis.focalLengthMm;
    const double radicand = sum * sum - 4.0 * f * f;
    if (!(sum > 0.0 && radicand >= 0.0))
        throw std::invalid_argument("focus distance " + std::to_string(objectDistanceMm) +
                                    " mm: the lens focuses no nearer than " +
                                    std::to_string(betweenFoci + 2.0 * f) + " mm from the sensor");
    return axis.backFocalDistanceMm + 2.0 * f * f / (sum + std::sqrt(radicand));
}

}  // namespace

double ParaxialAxis::entrancePupilRadiusMm(double stopRadiusMm) const {
    return std::abs(entrancePupilPerStop) * stopRadiusMm;
}

double ParaxialAxis::exitPupilRadiusMm(double stopRadiusMm) const {
    return std::abs(exitPupilPerStop) * stopRadiusMm;
}

ParaxialData paraxialData(const OpticalSystem& system, double wavelengthNm) {
    const std::vector<double> indices = refractiveIndices(system, wavelengthNm);
    return {axisData({system, indices, Plane::xz}), axisData({system, indices, Plane::yz}),
            system.surfaces.back().vertexZMm};
}

double sensorDistanceMm(const ParaxialData& data, double objectDistanceMm) {
    return 0.5 * (imageDistance(data.x, data.lastVertexZMm, objectDistanceMm) +
                  imageDistance(data.y, data.lastVertexZMm, objectDistanceMm));
}

double fNumber(const ParaxialData& data, double stopRadiusMm) {
    const auto axisNumber = [&](const ParaxialAxis& axis) {
        return axis.focalLengthMm / (2.0 * axis.entrancePupilRadiusMm(stopRadiusMm));
    };
    return std::sqrt(axisNumber(data.x) * axisNumber(data.y));
}

double stopRadiusMm(const ParaxialData& data, double number) { return fNumber(data, 1.0) / number; }

StopMap stopMap(const OpticalSystem& system, double sensorDistanceMm, double wavelengthNm) {
    const std::vector<double> indices = refractiveIndices(system, wavelengthNm);
    StopMap map;
    for (const auto& [plane, row] : {std::pair(Plane::xz, 0), std::pair(Plane::yz, 1)}) {
        const Section section{system, indices, plane};
        const RayMatrix matrix = section.rear() * propagation(sensorDistanceMm);
        map.bySensor[row] = matrix(0, 0);
        map.bySlope[row] = matrix(0, 1);
    }
    return map;
}

}  // namespace etendue
