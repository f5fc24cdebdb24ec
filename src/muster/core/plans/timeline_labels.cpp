// Labels that rise along every arc of the graph.
#include "plans/timeline.hpp"

#include <algorithm>
#include <utility>

namespace muster {

// Labels in an order in which the units can be done.
bool Timeline::label_topologically(const Routes& routes) {
  std::vector<std::vector<int>> next(problem_.units());
  std::vector<int> waiting(problem_.units(), 0), queue;
  std::vector<char> done(problem_.units(), 0);
  for (const auto& route : routes) {
    for (const int task : route) done[problem_.unit(task)] = 1;
  }
  const auto arc = [&](int from, int to) {
    next[from].push_back(to);
    ++waiting[to];
  };
  for (const auto& route : routes) {
    for (std::size_t k = 1; k < route.size(); ++k) arc(problem_.unit(route[k - 1]), problem_.unit(route[k]));
  }
  for (int unit = 0; unit < problem_.units(); ++unit) {
    if (!done[unit]) continue;
    for (const Arc& each : before_[unit]) {
      if (done[each.unit]) arc(each.unit, unit);
    }
  }
  for (int unit = 0; unit < problem_.units(); ++unit) {
    if (done[unit] && waiting[unit] == 0) queue.push_back(unit);
  }
  for (std::size_t k = 0; k < queue.size(); ++k) {
    for (const int unit : next[queue[k]]) {
      if (--waiting[unit] == 0) queue.push_back(unit);
    }
  }
  for (std::size_t k = 0; k < queue.size(); ++k) {
    nodes_[queue[k]].label = (static_cast<double>(k) + 1.0) / (static_cast<double>(queue.size()) + 1.0);
  }
  return static_cast<std::ptrdiff_t>(queue.size()) == std::ranges::count(done, 1);
}

// Every label that is in use, or that `rollback` would bring back.
std::vector<double*> Timeline::all_labels() {
  std::vector<double*> labels;
  for (std::size_t unit = 0; unit < nodes_.size(); ++unit) {
    if (present(static_cast<int>(unit))) labels.push_back(&nodes_[unit].label);
  }
  for (Change& change : changes_) {
    if (!change.inserted) labels.push_back(&change.label);
  }
  return labels;
}

// Gives labels equal distances, in the order given.
void Timeline::spread(const std::vector<double*>& labels) {
  const double gap = 1.0 / (static_cast<double>(labels.size()) + 1.0);
  for (std::size_t k = 0; k < labels.size(); ++k) *labels[k] = gap * (static_cast<double>(k) + 1.0);
  for (std::size_t unit = 0; unit < nodes_.size(); ++unit) {
    if (present(static_cast<int>(unit))) set_label(static_cast<int>(unit), nodes_[unit].label);
  }
}

// In order of time: an arc leads to a unit that begins no earlier, and where both begin at once its label is higher.
void Timeline::relabel() {
  std::vector<int> units;
  for (std::size_t unit = 0; unit < nodes_.size(); ++unit) {
    if (present(static_cast<int>(unit))) units.push_back(static_cast<int>(unit));
  }
  std::ranges::sort(units, [&](int a, int b) {
    const Node &x = nodes_[a], &y = nodes_[b];
    return x.begin != y.begin ? x.begin < y.begin : x.label < y.label;
  });
  std::vector<double*> labels;
  for (const int unit : units) labels.push_back(&nodes_[unit].label);
  spread(labels);
  unsorted_ = 0;
  ++relabelings_;
}

void Timeline::set_label(int unit, double label) {
  nodes_[unit].label = label;
  for (const int number : nodes_[unit].visits) visits_[number].label = label;
}

Labels Timeline::between(std::span<const Member> members) const {
  Labels labels{0.0, 1.0};
  for (const Member& member : members) {
    labels.low = std::max(labels.low, stop(member.robot, member.at).label);
    labels.high = std::min(labels.high, stop(member.robot, member.at + 1).label);
  }
  return labels;
}

Labels Timeline::labels_for(int unit) {
  Labels labels{0.0, 1.0};
  seek_labels(unit, true, labels);
  seek_labels(unit, false, labels);
  return labels;
}

void Timeline::seek_labels(int unit, bool back, Labels& labels) {
  ++stamp_;
  stack_.clear();
  const auto& arcs = back ? before_ : behind_;
  const auto go_on = [&](int from) {
    for (const Arc& arc : arcs[from]) stack_.push_back(arc.unit);
  };
  go_on(unit);
  while (!stack_.empty()) {
    const int other = stack_.back();
    stack_.pop_back();
    if (other == unit) labels.high = labels.low;  // it would wait for itself
    if (std::exchange(stamp_of_[other], stamp_) == stamp_) continue;
    if (!present(other)) {
      go_on(other);
    } else if (back) {
      labels.low = std::max(labels.low, nodes_[other].label);
    } else {
      labels.high = std::min(labels.high, nodes_[other].label);
    }
  }
}

}  // namespace muster
