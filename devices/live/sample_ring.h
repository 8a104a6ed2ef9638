#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace insonate {

/// A bounded queue from one thread to one other. Neither thread ever waits, takes a lock or allocates. Items that
/// arrive while it is full are dropped and counted.
template <typename T>
class SampleRing {
  static_assert(std::is_trivially_copyable_v<T>);

public:
  /// Makes room for at least `capacity` items, rounded up to a power of two.
  explicit SampleRing(std::size_t capacity) : items_(std::bit_ceil(capacity)) {}

  std::size_t capacity() const { return items_.size(); }

  /// Only for the one thread that fills the queue. Returns false if the item was dropped.
  bool push(const T& item) {
    const std::uint64_t written = written_.load(std::memory_order_relaxed);
    if (written - read_.load(std::memory_order_acquire) == items_.size()) {
      dropped_.fetch_add(1, std::memory_order_relaxed);
      return false;
    }
    items_[written & (items_.size() - 1)] = item;
    written_.store(written + 1, std::memory_order_release);
    return true;
  }

  /// Only for the one thread that empties the queue. Appends to `out` what was there when it was called, oldest first.
  void drain(std::vector<T>& out) {
    const std::uint64_t written = written_.load(std::memory_order_acquire);
    std::uint64_t read = read_.load(std::memory_order_relaxed);
    for (; read != written; ++read) out.push_back(items_[read & (items_.size() - 1)]);
    read_.store(read, std::memory_order_release);
  }

  /// Any thread may call it.
  std::uint64_t dropped() const { return dropped_.load(std::memory_order_relaxed); }

private:
  static constexpr std::size_t kCacheLine = 64;  // so that the two threads do not write to the same one

  std::vector<T> items_;
  alignas(kCacheLine) std::atomic<std::uint64_t> written_{0};
  std::atomic<std::uint64_t> dropped_{0};
  alignas(kCacheLine) std::atomic<std::uint64_t> read_{0};
};

}  // namespace insonate
