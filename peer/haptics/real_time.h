// What a thread that talks to devices asks of the kernel.
#pragma once

namespace slosh {

/// For the calling thread: its name, timers to the microsecond, a stack that is there, real-time priority
/// where that is granted, else a short slice, and no signals (they are for the main thread: a handler that
/// waits for this one must not run on it). True when the priority was granted.
bool become_device_thread(const char* name) noexcept;

/// Asks that what this process has mapped stays in memory once it was touched (MCL_CURRENT, MCL_ONFAULT), so
/// that no tick waits for the disk. Not for what is mapped later: with a limit on locked memory that would
/// refuse large worlds their memory. True when the kernel granted it.
bool lock_memory() noexcept;

}  // namespace slosh
