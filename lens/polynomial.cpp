#include "lens/polynomial.h"

#include <stdexcept>
#include <utility>

#include "lens/fit_check.h"

namespace etendue {

namespace {

/// Coefficients in the order of slots, by row of the group or -1 for zeros.
Eigen::MatrixXd inSlots(const Eigen::MatrixXd& coefficients, const std::vector<int>& rows) {
    Eigen::MatrixXd result =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.size()), coefficients.cols());
    for (std::size_t slot = 0; slot < rows.size(); ++slot)
        if (rows[slot] >= 0)
            result.row(static_cast<Eigen::Index>(slot)) = coefficients.row(rows[slot]);
    return result;
}

}  // namespace

template <class T>
PolynomialEvaluator<T>::PolynomialEvaluator(const SparsePolynomial& polynomial,
                                            VectorRegisters registers)
    : basis_(polynomial.basis),
      outputs_(polynomial.outputs),
      scaling_(polynomial.scaling),
      registers_(registers) {
    if (outputs_.total() > mostOutputs || outputs_.vectors > mostVectors)
        throw std::invalid_argument("polynomial: more outputs than can be evaluated together");
    if (const auto fault = findFault(polynomial))
        throw std::invalid_argument("polynomial: " + *fault);
    const Eigen::Vector2d coupled = scaling_.secondScale * scaling_.coupling;
    factors_ = {static_cast<T>(scaling_.sensorScale),
                static_cast<T>(scaling_.secondScale),
                {static_cast<T>(coupled.x()), static_cast<T>(coupled.y())}};
    for (const TermGroup& group : polynomial.groups) groups_.push_back(compile(group));
}

template <class T>
typename PolynomialEvaluator<T>::Group PolynomialEvaluator<T>::compile(
    const TermGroup& group) const {
    const bool axial = basis_ == PolynomialBasis::axial;
    std::vector<int> rows, scalars;  // of the group, in the order of slots
    for (std::size_t row = 0; row < group.outputs.size(); ++row)
        (group.outputs[row] < 2 * outputs_.vectors ? rows : scalars)
            .push_back(static_cast<int>(row));
    const bool hasVectors = !rows.empty();
    if (hasVectors) rows.resize(4, -1);
    if (hasVectors && axial) rows = {rows[0], rows[2], rows[1], rows[3]};
    SlotUse use{0, {-1, -1, -1, -1}, 0, static_cast<int>(scalars.size())};
    if (!scalars.empty())
        use.firstScalar = group.outputs[static_cast<std::size_t>(scalars.front())];
    for (std::size_t slot = 0; slot < rows.size(); ++slot)
        if (rows[slot] >= 0) {
            use.vectorSlots = static_cast<int>(slot) + 1;
            use.components[slot] = group.outputs[static_cast<std::size_t>(rows[slot])];
        }
    rows.insert(rows.end(), scalars.begin(), scalars.end());
    rows.resize((rows.size() + 3) / 4 * 4, -1);
    // Those outermost whose derivatives are wanted most often: ρ κ σ w, x y px py w.
    const std::vector<std::size_t> levels =
        axial ? std::vector<std::size_t>{0, 2, 1, 3} : std::vector<std::size_t>{0, 1, 2, 3, 4};
    return {use, HornerScheme<T>(group.terms, inSlots(group.coefficients, rows), levels)};
}

template class PolynomialEvaluator<float>;
template class PolynomialEvaluator<double>;

}  // namespace etendue
