#include "lens/prescription.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "lens/hash.h"

namespace etendue {

namespace {

bool isCylinder(const Surface& surface) {
    return surface.kind == SurfaceKind::cylinderX || surface.kind == SurfaceKind::cylinderY;
}

class ContentHash {
public:
    void add(std::uint64_t word) { hash_.add(word); }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number == 0.0 ? 0.0 : number)); }
    void add(const Glass& glass) {
        add(static_cast<std::uint64_t>(glass.index()));
        if (const auto* conrady = std::get_if<ConradyGlass>(&glass))
            for (const double term : {conrady->a, conrady->b, conrady->c}) add(term);
        if (const auto* sellmeier = std::get_if<SellmeierGlass>(&glass))
            for (const auto& terms : {sellmeier->b, sellmeier->c})
                for (const double term : terms) add(term);
    }
    void add(const Coating& coating) {
        for (const double number :
             {coating.index, coating.designWavelengthNm, coating.thicknessWaves})
            add(number);
    }
    std::uint64_t value() const { return hash_.value(); }

private:
    Fnv1a hash_;
};

}  // namespace

SurfaceShape lensSpaceShape(const Surface& surface) {
    SurfaceShape shape;
    shape.curvature = std::isinf(surface.radiusMm) ? 0.0 : -1.0 / surface.radiusMm;
    shape.conic = surface.conic;
    for (std::size_t i = 0; i < shape.asphere.size(); ++i) {
        if (surface.asphere[i] != 0.0) shape.asphere[i] = -surface.asphere[i];
        shape.isAsphere |= surface.asphere[i] != 0.0;
    }
    shape.curvedInX = surface.kind != SurfaceKind::cylinderY;
    shape.curvedInY = surface.kind != SurfaceKind::cylinderX;
    return shape;
}

std::size_t stopIndex(const Prescription& prescription) {
    const auto stop = std::ranges::find(prescription.surfaces, SurfaceKind::stop, &Surface::kind);
    return static_cast<std::size_t>(stop - prescription.surfaces.begin());
}

double lengthMm(const Prescription& prescription) {
    double length = 0.0;
    for (std::size_t i = 0; i + 1 < prescription.surfaces.size(); ++i)
        length += prescription.surfaces[i].thicknessMm;
    return length;
}

bool isAnamorphic(const Prescription& prescription) {
    return std::ranges::any_of(prescription.surfaces, isCylinder);
}

Prescription scaled(const Prescription& prescription, double factor) {
    Prescription result = prescription;
    StatedData& stated = result.stated;
    for (double* length : {&stated.focalLengthXMm, &stated.focalLengthYMm,
                           &stated.backFocalDistanceXMm, &stated.backFocalDistanceYMm})
        *length *= factor;
    for (Surface& surface : result.surfaces) {
        surface.radiusMm *= factor;
        surface.thicknessMm *= factor;
        surface.semiApertureMm *= factor;
        double power = 1.0 / (factor * factor * factor);  // of a₄; two more for each that follows
        for (double& coefficient : surface.asphere) {
            coefficient *= power;
            power /= factor * factor;
        }
    }
    return result;
}

std::uint64_t contentHash(const Prescription& prescription) {
    ContentHash hash;
    for (const Surface& surface : prescription.surfaces) {
        hash.add(static_cast<std::uint64_t>(surface.kind));
        for (const double number :
             {surface.radiusMm, surface.thicknessMm, surface.semiApertureMm, surface.conic})
            hash.add(number);
        for (const double coefficient : surface.asphere) hash.add(coefficient);
        hash.add(surface.behind);
        hash.add(static_cast<std::uint64_t>(surface.coating.has_value()));
        if (surface.coating) hash.add(*surface.coating);
    }
    return hash.value();
}

}  // namespace etendue
