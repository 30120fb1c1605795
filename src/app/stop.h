// Enters: Ctrl-C, or SIGTERM.
// Leaves: that the user wants an end; who renders writes what is there.
#pragma once

namespace ajar {

/// From now on the first signal asks to stop; a second one ends the program at once.
void catch_stop();
bool stop_asked();

}  // namespace ajar
