#include "renderer/wavelengths.h"

#include <Eigen/Dense>
#include <cmath>
#include <vector>

#include "renderer/colorimetry.h"

namespace etendue {

namespace {

constexpr int nodes = 61;
constexpr double firstNm = Wavelengths::shortestNm, lastNm = Wavelengths::longestNm;
constexpr double stepNm = (lastNm - firstNm) / (nodes - 1);
constexpr double nmAt(int node) { return firstNm + stepNm * node; }

using Rows = Eigen::Matrix<double, 3, nodes>;

/// The trapezoidal rule's weights.
double nodeWeight(int node) { return node == 0 || node == nodes - 1 ? 0.5 : 1.0; }

/// X, Y, Z of light of D65's spectrum at each node, so that all of it is Rec. 709's white.
Rows xyzResponse() {
    Rows rows;
    for (int i = 0; i < nodes; ++i) {
        const Vec3d xyz = xyzMatching(nmAt(i)) * d65(nmAt(i));
        rows.col(i) << xyz.x, xyz.y, xyz.z;
    }
    const Vec3d white = xyzFromRec709({1.0, 1.0, 1.0});
    for (int c = 0; c < 3; ++c) {
        double sum = 0.0;
        for (int i = 0; i < nodes; ++i) sum += rows(c, i) * nodeWeight(i);
        rows.row(c) *= white[c] / sum;
    }
    return rows;
}

/// The same, as R, G, B, with the weights of the rule: a spectrum's colour is a product with it.
Rows rgbWeights(const Rows& xyz) {
    Rows rows;
    for (int i = 0; i < nodes; ++i) {
        const Vec3d rgb = rec709FromXyz({xyz(0, i), xyz(1, i), xyz(2, i)}) * nodeWeight(i);
        rows.col(i) << rgb.x, rgb.y, rgb.z;
    }
    return rows;
}

/// The spectra of the primaries: positive, with a sum of one at every wavelength, each of exactly
/// its own colour, so that any reflectance in [0, 1]³ becomes a spectrum in [0, 1] of that colour
/// (the idea of Mallett and Yuksel 2019, "Spectral Primary Decomposition for Rendering with sRGB
/// Reflectance"). Here they are the softmax of two curves and zero, of all such curves the
/// smoothest: the least sum of squared second differences under six constraints, by Newton's method
/// on Lagrange's conditions.
Rows primarySpectra(const Rows& weights) {
    constexpr int unknowns = 2 * nodes, constraints = 6;
    using Vector = Eigen::VectorXd;
    using Matrix = Eigen::MatrixXd;
    Matrix differences = Matrix::Zero(2 * (nodes - 2), unknowns);
    for (int curve = 0; curve < 2; ++curve)
        for (int i = 0; i < nodes - 2; ++i)
            differences.block<1, 3>(curve * (nodes - 2) + i, curve * nodes + i) << 1.0, -2.0, 1.0;
    const Matrix roughness =
        differences.transpose() * differences + 1e-6 * Matrix::Identity(unknowns, unknowns);

    // Red over blue rises with the wavelength; green over blue has its peak in the middle.
    Vector curves(unknowns);
    for (int i = 0; i < nodes; ++i) {
        const double x = (nmAt(i) - 540.0) / 20.0;
        curves[i] = x;
        curves[nodes + i] = 4.0 + 0.5 * x - x * x / 5.0;
    }
    Rows spectra;
    constexpr int mostSteps = 100;
    for (int step = 0; step < mostSteps; ++step) {
        Vector residual(constraints);
        Matrix jacobian(constraints, unknowns);
        for (int i = 0; i < nodes; ++i) {
            const Eigen::Array3d exponents(curves[i], curves[nodes + i], 0.0);
            const Eigen::Array3d powers = (exponents - exponents.maxCoeff()).exp();
            spectra.col(i) = (powers / powers.sum()).matrix();
        }
        for (int curve = 0; curve < 2; ++curve)
            for (int c = 0; c < 3; ++c) {
                const int row = 3 * curve + c;
                residual[row] = spectra.row(curve).dot(weights.row(c)) - (curve == c ? 1.0 : 0.0);
                for (int i = 0; i < nodes; ++i)
                    for (int by = 0; by < 2; ++by)
                        jacobian(row, by * nodes + i) =
                            weights(c, i) * spectra(curve, i) *
                            ((curve == by ? 1.0 : 0.0) - spectra(by, i));
            }
        Matrix system = Matrix::Zero(unknowns + constraints, unknowns + constraints);
        system.topLeftCorner(unknowns, unknowns) = roughness;
        system.topRightCorner(unknowns, constraints) = jacobian.transpose();
        system.bottomLeftCorner(constraints, unknowns) = jacobian;
        Vector target(unknowns + constraints);
        target << -roughness * curves, -residual;
        const Vector change = system.fullPivLu().solve(target).head(unknowns);
        constexpr double longest = 2.0;  // damping far from the end
        curves += change * std::min(1.0, longest / change.cwiseAbs().maxCoeff());
        if (change.norm() < 1e-10) break;
    }
    return spectra;
}

/// All six curves at the nodes, and straight between them: the primaries, then X, Y and Z.
struct Curves {
    std::array<std::array<float, nodes>, 6> at;

    Curves() {
        const Rows xyz = xyzResponse();
        const Rows primaries = primarySpectra(rgbWeights(xyz));
        for (std::size_t c = 0; c < 3; ++c)
            for (int i = 0; i < nodes; ++i) {
                const auto node = static_cast<std::size_t>(i);
                const auto row = static_cast<int>(c);
                at[c][node] = static_cast<float>(primaries(row, i));
                at[3 + c][node] = static_cast<float>(xyz(row, i) * (nodes - 1));
            }
    }

    Spectrum lanes(std::size_t curve, const std::array<float, Spectrum::lanes>& nm) const {
        return Spectrum::fromLanes([&](int lane) {
            const float place = (nm[static_cast<std::size_t>(lane)] - Wavelengths::shortestNm) *
                                static_cast<float>(1.0 / stepNm);
            const auto node = std::min(static_cast<std::size_t>(place), std::size_t{nodes - 2});
            const float t = place - static_cast<float>(node);
            return at[curve][node] + t * (at[curve][node + 1] - at[curve][node]);
        });
    }
};

}  // namespace

Spectrum SpectralSample::onFilm(const Spectrum& lanes) const {
    if (!wavelengths.isSpectral) return lanes;
    const auto sum = [&](const Spectrum& response) {
        const Spectrum s = lanes * response;
        return (s[0] + s[1] + s[2] + s[3]) * (1.0f / Spectrum::lanes);
    };
    return {sum(xyz[0]), sum(xyz[1]), sum(xyz[2]), 0.0f};
}

SpectralSample sampleWavelengths(float u) {
    static const Curves curves;
    SpectralSample sample;
    Wavelengths& w = sample.wavelengths;
    w.isSpectral = true;
    for (std::size_t lane = 0; lane < w.nm.size(); ++lane) {
        float place = u + static_cast<float>(lane) / Spectrum::lanes;
        if (place >= 1.0f) place -= 1.0f;
        w.nm[lane] = std::lerp(Wavelengths::shortestNm, Wavelengths::longestNm, place);
    }
    for (std::size_t c = 0; c < 3; ++c) {
        w.primaries[c] = curves.lanes(c, w.nm);
        sample.xyz[c] = curves.lanes(3 + c, w.nm);
    }
    return sample;
}

}  // namespace etendue
