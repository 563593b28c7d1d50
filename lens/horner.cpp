#include "lens/horner.h"

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
        int highest = 0;
        for (const std::size_t term : among)
            highest = std::max<int>(highest, terms[term][variable]);
        scheme.counts.push_back(static_cast<std::uint8_t>(highest + 1));
        for (int power = highest; power >= 0; --power) {
            std::vector<std::size_t> inner;
            for (const std::size_t term : among)
                if (terms[term][variable] == power) inner.push_back(term);
            descend(inner, level + 1);
        }
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
