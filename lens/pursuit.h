// Pursuit: orthogonal matching pursuit on the outputs that share their terms.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "lens/orthogonal_columns.h"
#include "lens/prospects.h"

namespace etendue {

class Pursuit {
public:
    /// Both are kept by reference. `onTerm` is called for every term taken by growTo().
    Pursuit(const MonomialTable& table, const std::vector<OutputFamily>& families,
            std::function<void()> onTerm = {});

    /// Takes the most useful term until there are `count`, or none would help.
    void growTo(std::size_t count);
    /// Backward elimination: drops whichever term costs least, one at a time.
    void pruneTo(std::size_t count);
    void restart(std::span<const Eigen::Index> support);

    /// Terms of the table in the order in which they were taken.
    const std::vector<Eigen::Index>& support() const { return support_; }
    double residualSquared() const;
    /// Coefficient rows × terms in the order of support().
    Eigen::MatrixXd coefficients(Eigen::Index rows) const;

private:
    void take(std::span<const Eigen::Index> terms);
    std::optional<Eigen::Index> mostUseful() const;

    const MonomialTable& table_;
    const std::vector<OutputFamily>& families_;
    std::function<void()> onTerm_;
    double targetsSquared_ = 0.0;
    std::vector<Prospects> atStart_, prospects_;  // of each family
    std::vector<OrthogonalColumns> chosen_;
    std::vector<Eigen::Index> support_;
};

}  // namespace etendue
