#pragma once

#include <stop_token>
#include <thread>

namespace insonate {

/// Takes over a thread that has been asked to end, from an owner that does not wait for it. The process waits for the
/// thread at its exit.
void detach_thread(std::jthread thread);

/// Waits until all threads that were detached before have ended. Returns at once if the calling thread, whose token is
/// `stop`, has itself been asked to end, so that no two threads wait for each other.
void join_detached_threads(const std::stop_token& stop);

/// Returns how many threads are waiting in join_detached_threads() now.
int waiting_for_detached_threads();

}  // namespace insonate
