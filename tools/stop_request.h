// Signals that ask a long command to stop with what it has so far, or to write it down.
#pragma once

namespace etendue {

/// From now on the first SIGINT or SIGTERM asks to stop, and the second one ends at once.
void heedStopRequests();

bool isStopRequested();

/// From now on SIGUSR1 asks to write down what there is.
void heedWriteRequests();

/// Whether anybody has asked since this was called last.
bool takeWriteRequest();

}  // namespace etendue
