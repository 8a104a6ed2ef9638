#pragma once

#include <stop_token>
#include <thread>

namespace insonate {

/// Takes a thread that was asked to end, from an owner who does not wait for it. The process waits for it at its end.
void detach_thread(std::jthread thread);

/// Waits until every thread that was left before has ended; returns at once when the calling thread, whose token `stop`
/// is, was itself asked to end, so that no two ever wait for each other.
void join_detached_threads(const std::stop_token& stop);

/// How many threads wait in join_detached_threads() now, for a thread that was left.
int waiting_for_detached_threads();

}  // namespace insonate
