// Numbers as messages about prescriptions write them.
#pragma once

#include <sstream>
#include <string>

namespace etendue {

/// To six digits.
inline std::string numberText(double value) {
    std::ostringstream text;
    text.precision(6);
    text << value;
    return text.str();
}

}  // namespace etendue
