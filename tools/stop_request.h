// Signals that ask a long command to stop, with what it has so far.
#pragma once

namespace etendue {

/// From now on the first SIGINT or SIGTERM asks to stop, and the second one ends at once.
void heedStopRequests();

bool isStopRequested();

}  // namespace etendue
