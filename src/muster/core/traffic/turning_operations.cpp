#include "traffic/turning_operations.hpp"

#include <set>
#include <string>

namespace muster {

namespace {

// What an operation comes to without obstacles: x and y at each step, then the heading.
std::vector<int> track_of(const std::string& actions) {
  static constexpr int kX[] = {1, 0, -1, 0}, kY[] = {0, 1, 0, -1};
  std::vector<int> track;
  int x = 0, y = 0, heading = 0;
  for (const char action : actions) {
    if (action == 'F') {
      x += kX[heading];
      y += kY[heading];
    } else {
      heading = (heading + (action == 'R' ? 1 : action == 'C' ? 3 : 0)) % 4;
    }
    track.insert(track.end(), {x, y});
  }
  track.push_back(heading);
  return track;
}

}  // namespace

TurningOperations::TurningOperations() {
  static constexpr char kActions[] = {'F', 'R', 'C', 'W'};
  int count = 1;
  for (int k = 0; k < kOperationSteps; ++k) count *= 4;
  std::set<std::vector<int>> tracks;
  std::vector<std::string> kept;  // in lexicographic order of kActions
  for (int number = 0; number < count; ++number) {
    std::string actions;
    for (int place = count / 4; place > 0; place /= 4) actions += kActions[number / place % 4];
    if (tracks.insert(track_of(actions)).second) kept.push_back(actions);
  }
  std::string before;
  for (const std::string& actions : kept) {
    std::size_t depth = 0;
    while (depth < before.size() && before[depth] == actions[depth]) ++depth;
    for (; depth < actions.size(); ++depth) nodes_.push_back({actions[depth], static_cast<int>(depth) + 1, 0});
    before = actions;
  }
  for (std::size_t k = 0; k < nodes_.size(); ++k) {
    std::size_t beside = k + 1;
    while (beside < nodes_.size() && nodes_[beside].depth > nodes_[k].depth) ++beside;
    nodes_[k].beside = beside;
  }
}

}  // namespace muster
