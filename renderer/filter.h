// Filter: how a pixel weighs the film around its centre. Every filter here is positive, separable
// and normalised exactly, so that it is drawn from (filter importance sampling, Ernst, Stamminger
// and Greiner 2006) and each camera sample belongs to one pixel with weight 1. It weighs splats.
#pragma once

#include "renderer/vec.h"

namespace etendue {

enum class FilterKind { box, gaussian, blackmanHarris };

/// Half the filter's width, in pixels: 0.5 for the box, which then covers one pixel; 1.5 else.
float defaultRadius(FilterKind kind);

class Filter {
public:
    /// `radius` in pixels scales the whole filter: the Gaussian's standard deviation is radius / 3,
    /// the Blackman–Harris window's (four terms, Harris 1978) about 0.28 radius. Throws
    /// std::invalid_argument unless it is positive and finite.
    explicit Filter(FilterKind kind) : Filter(kind, defaultRadius(kind)) {}
    Filter(FilterKind kind, float radius);

    /// The offset of a camera sample from its pixel's centre, in pixels; each axis in
    /// [−radius, radius). `u` in [0, 1)².
    Vec2 sample(Vec2 u) const;
    /// The density of sample(), 1/pixel²: the filter itself. A splat is multiplied by it.
    float pdfFilm(Vec2 offset) const {
        return static_cast<float>(pdfAxis(offset.x) * pdfAxis(offset.y));
    }
    /// Its factor for one axis, 1/pixel.
    double pdfAxis(float offset) const {
        if (!(-radius_ <= offset && offset < radius_)) return 0.0;
        return kind_ == FilterKind::box ? peak_ : peak_ * relativeToBox(offset);
    }

    FilterKind kind() const { return kind_; }
    float radius() const { return radius_; }

private:
    struct Table;
    static const Table& tableOf(FilterKind kind);

    float sampleAxis(float u) const;
    double relativeToBox(float offset) const;

    FilterKind kind_;
    float radius_;
    double peak_;         // 1/pixel: of the box on one axis
    const Table* table_;  // one for each kind, made on first use
};

}  // namespace etendue
