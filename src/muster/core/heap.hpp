// A heap of four children a node, shallower than two and easier on the memory.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace muster {

// The item with the least `key` first.
template <class Item>
class Heap {
 public:
  bool empty() const { return items_.empty(); }
  const Item& top() const { return items_.front(); }
  void clear() { items_.clear(); }

  void push(Item item) {
    std::size_t at = items_.size();
    items_.push_back(item);
    for (; at > 0 && item.key < items_[(at - 1) / 4].key; at = (at - 1) / 4) items_[at] = items_[(at - 1) / 4];
    items_[at] = item;
  }

  Item pop() {
    const Item top = items_.front(), last = items_.back();
    items_.pop_back();
    if (items_.empty()) return top;
    std::size_t at = 0;
    for (std::size_t child = 1; child < items_.size(); child = 4 * at + 1) {
      const std::size_t end = child + 4 < items_.size() ? child + 4 : items_.size();
      std::size_t least = child;
      for (std::size_t k = child + 1; k < end; ++k) {
        if (items_[k].key < items_[least].key) least = k;
      }
      if (!(items_[least].key < last.key)) break;
      items_[at] = items_[least];
      at = least;
    }
    items_[at] = last;
    return top;
  }

 private:
  std::vector<Item> items_;
};

}  // namespace muster
