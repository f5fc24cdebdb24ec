// The same work for many agents, on several threads. Which thread does what makes no difference to the result.
#pragma once

#include <algorithm>
#include <thread>
#include <vector>

namespace muster {

// Calls work(begin, end) for parts of 0 to count - 1 that together are all of it.
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
