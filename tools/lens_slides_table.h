// etendue lens trade --slides: the published accuracy table, measured again.
#pragma once

#include "config/config.h"

namespace etendue {

ExitCode runSlidesTable(bool asJson);

}  // namespace etendue
