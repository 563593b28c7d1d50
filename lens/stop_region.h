// StopRegion: with which slopes light that reaches the sensor can cross the stop. What lies outside
// need not be searched for.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "lens/lens_model.h"
#include "lens/sequential_trace.h"

namespace etendue {

/// A box for each of some distances of the aperture point from the axis, found by tracing: every
/// slope of a ray that passes all rims lies in it, with a margin for what was traced between.
class StopRegion {
public:
    /// At every wavelength.
    StopRegion(const OpticalSystem& system, double sensorZMm);

    /// By how much the slope is outside; 0 inside.
    double distanceTo(AperturePoint aperture, const Eigen::Vector2d& slope) const {
        return (slope - nearest(aperture, slope)).norm();
    }
    /// The slope inside nearest to it.
    Eigen::Vector2d nearest(AperturePoint aperture, const Eigen::Vector2d& slope) const;

    /// The slope of the ray that paraxially comes from the sensor's centre.
    Eigen::Vector2d centre(const Eigen::Vector2d& aperture) const {
        return centrePerMm_.cwiseProduct(aperture);
    }

    bool isAxial() const { return isAxial_; }
    /// The largest slope of a ray that passes; 0 if none was found.
    double steepest() const;

    /// Rays that pass close to a rim.
    struct EdgeRay {
        Eigen::Vector2d aperture, slope;
    };
    const std::vector<EdgeRay>& edge() const { return edge_; }

private:
    /// From the centre, along the aperture point's direction and across it; about a lens that is
    /// not of revolution along x and along y.
    struct Box {
        double lowest, highest, widest;
    };
    static constexpr std::size_t ringCount = 9;

    void widen(Box& box, const MonochromaticSystem& lens, const Eigen::Vector2d& aperture);
    /// For every aperture point.
    void widenForAll(Box& box, const MonochromaticSystem& lens);
    /// For aperture points between two rings, with a margin.
    static Box between(const Box& inner, const Box& outer);
    double outermost(const MonochromaticSystem& lens, const Eigen::Vector2d& aperture,
                     const Eigen::Vector2d& along) const;

    bool isAxial_;
    double ringsPerMm_;
    Eigen::Vector2d centrePerMm_;
    std::array<Box, ringCount - 1> boxes_;  // from each ring to the next
    std::vector<EdgeRay> edge_;
};

}  // namespace etendue
