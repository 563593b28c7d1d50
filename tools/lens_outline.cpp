#include "tools/lens_outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace etendue {

namespace {

/// What joins the upper rims of two faces: nothing, or the corner of a flat.
std::vector<SectionPoint> corner(const SectionPoint& front, const SectionPoint& rear) {
    if (front.x() > rear.x() || front.y() == rear.y()) return {};
    const bool frontIsLarger = front.y() > rear.y();
    return {frontIsLarger ? SectionPoint(rear.x(), front.y()) : SectionPoint(front.x(), rear.y())};
}

SectionPoint mirrored(const SectionPoint& point) { return {point.x(), -point.y()}; }

}  // namespace

SectionPoint inSection(const Eigen::Vector3d& pointMm, SectionPlane plane) {
    return {-pointMm.z(), plane == SectionPlane::xz ? pointMm.x() : pointMm.y()};
}

std::vector<SectionPoint> surfaceProfile(const TracedSurface& surface, SectionPlane plane) {
    constexpr int steps = 64;
    std::vector<SectionPoint> points;
    for (int i = 0; i <= steps; ++i) {
        // Closer toward the rims, where a steep surface turns most in height.
        const double height =
            surface.semiApertureMm * std::sin(0.5 * std::numbers::pi * (2.0 * i / steps - 1.0));
        const double squared = plane == SectionPlane::xz
                                   ? heightSquared(surface.shape, height, 0.0)
                                   : heightSquared(surface.shape, 0.0, height);
        points.emplace_back(-(surface.vertexZMm + sag(surface.shape, squared)), height);
    }
    return points;
}

std::vector<GlassElement> glassElements(const OpticalSystem& system, SectionPlane plane) {
    const std::vector<double> indices = refractiveIndices(system, dLineNm);
    std::vector<GlassElement> elements;
    for (std::size_t i = 0; i + 1 < system.surfaces.size(); ++i) {
        if (std::holds_alternative<Air>(system.media[i + 1])) continue;
        GlassElement element{surfaceProfile(system.surfaces[i], plane), indices[i + 1]};
        std::vector<SectionPoint> rear = surfaceProfile(system.surfaces[i + 1], plane);
        const std::vector<SectionPoint> edge = corner(element.outline.back(), rear.back());
        std::ranges::reverse(rear);
        const auto append = [&](const std::vector<SectionPoint>& points) {
            element.outline.insert(element.outline.end(), points.begin(), points.end());
        };
        append(edge);
        append(rear);
        for (const SectionPoint& point : edge) element.outline.push_back(mirrored(point));
        elements.push_back(std::move(element));
    }
    return elements;
}

}  // namespace etendue
