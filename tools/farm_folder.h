// The folder of a picture that many machines render: of what it is, and how far.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "tools/farm_scripts.h"

namespace etendue {

/// Makes the folder and what belongs in it, and farm.toml, which says of which scene and settings
/// its parts are: `sceneHash` is LoadedScene's. Throws InputError, naming the setting, where that
/// file says something else.
void claimFarmFolder(const FarmJob& job, const std::string& sceneHash);

/// The tasks whose parts are not there or not complete. `notice` hears of damaged parts; one that
/// no render can mend is set aside, under a name that nothing else reads.
std::vector<std::uint32_t> missingTasks(const FarmJob& job,
                                        const std::function<void(const std::string&)>& notice);

}  // namespace etendue
