// Independent pieces of work over threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace muster {

// Calls make() once a thread, and what it returns for each k in [0, count), in any order. Throws what a call throws.
template <class Make>
void for_each_parallel(int count, int threads, Make make) {
  std::atomic<int> next{0};
  std::exception_ptr trouble;
  std::mutex lock;
  const auto work = [&] {
    try {
      auto call = make();
      for (int k = next++; k < count; k = next++) call(k);
    } catch (...) {
      const std::scoped_lock held(lock);
      trouble = std::current_exception();
      next = count;
    }
  };
  {
    std::vector<std::jthread> others;
    for (int k = 1; k < std::min(threads, count); ++k) others.emplace_back(work);
    work();
  }
  if (trouble) std::rethrow_exception(trouble);
}

}  // namespace muster
