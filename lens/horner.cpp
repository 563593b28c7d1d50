#include "lens/horner.h"

#include <functional>
#include <set>

namespace etendue {

namespace {

/// Terms that agree in the exponents of all levels outside of this one.
template <class T>
struct HornerWalk {
    HornerScheme<T>& scheme;
    const std::vector<Exponents>& terms;
    const Eigen::MatrixXd& coefficients;
    const std::vector<std::size_t>& order;

    void descend(const std::vector<std::size_t>& among, std::size_t level) {
        if (level == order.size()) {
            for (Eigen::Index slot = 0; slot < coefficients.rows(); ++slot) {
                double sum = 0.0;
                for (const std::size_t term : among)
                    sum += coefficients(slot, static_cast<Eigen::Index>(term));
                scheme.coefficients.push_back(static_cast<T>(sum));
            }
            return;
        }
        const std::size_t variable = order[level];
        const std::vector<int> powers = powersOf(among, variable);
        scheme.counts.push_back(static_cast<std::uint8_t>(powers.size()));
        for (std::size_t i = 0; i < powers.size(); ++i) {
            std::vector<std::size_t> inner;
            for (const std::size_t term : among)
                if (terms[term][variable] == powers[i]) inner.push_back(term);
            descend(inner, level + 1);
            const int next = i + 1 < powers.size() ? powers[i + 1] : 0;
            if (hasGaps(static_cast<int>(order.size())))
                scheme.counts.push_back(static_cast<std::uint8_t>(powers[i] - next));
        }
    }

    /// From the highest down, zero at least; without gaps unless the sweep can skip them.
    std::vector<int> powersOf(const std::vector<std::size_t>& among, std::size_t variable) const {
        std::set<int, std::greater<>> powers;
        for (const std::size_t term : among) powers.insert(terms[term][variable]);
        if (powers.empty()) powers.insert(0);
        if (!hasGaps(static_cast<int>(order.size())))
            for (int power = *powers.begin(); power >= 0; --power) powers.insert(power);
        return {powers.begin(), powers.end()};
    }
};

}  // namespace

template <class T>
HornerScheme<T>::HornerScheme(const std::vector<Exponents>& terms,
                              const Eigen::MatrixXd& slotCoefficients,
                              const std::vector<std::size_t>& order)
    : slots(static_cast<std::size_t>(slotCoefficients.rows())) {
    std::vector<std::size_t> all(terms.size());
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = i;
    HornerWalk<T>{*this, terms, slotCoefficients, order}.descend(all, 0);
}

template struct HornerScheme<float>;
template struct HornerScheme<double>;

}  // namespace etendue
