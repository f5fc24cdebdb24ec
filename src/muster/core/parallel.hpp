// Work over threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace muster {

// What the calling thread does between its pieces of work, ten times a second at most. What it throws ends the work.
using Pause = std::function<void()>;

// Calls `pause` when it is due.
class Pauses {
 public:
  explicit Pauses(const Pause& pause) : pause_(pause) {}
  void next() {
    const auto now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    pause_();
  }

 private:
  using Clock = std::chrono::steady_clock;
  const Pause& pause_;
  Clock::time_point last_ = Clock::now();
};

// Calls make() once a thread, and what it returns for each k in [0, count), in any order. Throws what a call throws.
template <class Make>
void for_each_parallel(int count, int threads, const Pause& pause, Make make) {
  std::atomic<int> next{0};
  std::exception_ptr trouble;
  std::mutex lock;
  const auto work = [&](auto between) {
    try {
      auto call = make();
      for (int k = next++; k < count; k = next++) {
        call(k);
        between();
      }
    } catch (...) {
      const std::scoped_lock held(lock);
      trouble = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> others;
    for (int k = 1; k < std::min(threads, count); ++k) others.emplace_back([&] { work([] {}); });
    work([pauses = Pauses(pause)]() mutable { pauses.next(); });
  }
  if (trouble) std::rethrow_exception(trouble);
}

// The same without a pause, for work that is over soon.
template <class Make>
void for_each_parallel(int count, int threads, Make make) {
  for_each_parallel(count, threads, [] {}, std::move(make));
}

// Calls work(begin, end) for parts of 0 to count - 1 that together are all of it, where a piece is small.
template <typename Work>
void in_parts(int count, int threads, const Work& work) {
  threads = std::clamp(threads, 1, std::max(1, count));
  std::vector<std::jthread> others;
  const auto bound = [&](int part) { return static_cast<int>(static_cast<long>(count) * part / threads); };
  for (int part = 1; part < threads; ++part)
    others.emplace_back([&work, begin = bound(part), end = bound(part + 1)] { work(begin, end); });
  work(0, bound(1));
}

}  // namespace muster
