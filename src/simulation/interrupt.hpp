#pragma once

namespace riven {

/// From now on SIGINT and SIGTERM ask the run to stop instead of killing it; a second one kills.
void watch_interrupts();

[[nodiscard]] bool interrupt_requested();

}  // namespace riven
