// What it costs to ask a scene's camera.
#pragma once

#include "renderer/scene_loader.h"
#include "tools/bench_records.h"

namespace etendue {

/// Time for a camera ray and for a connection of a point that the camera sees, of one thread,
/// medians over several runs; `camera` and `variant` are left to the caller.
BenchLens measureLens(const LoadedScene& loaded);

}  // namespace etendue
