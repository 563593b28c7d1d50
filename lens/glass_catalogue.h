// The makers' published glasses, as data.
#pragma once

#include <span>
#include <string_view>

#include "lens/glass.h"

namespace etendue {

struct CatalogueGlass {
    std::string_view name;
    double nd, vd;  // as published: a check on the coefficients
    SellmeierGlass dispersion;
};

std::span<const CatalogueGlass> glassCatalogue();

}  // namespace etendue
