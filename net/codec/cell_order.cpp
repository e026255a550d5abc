#include "net/codec/cell_order.h"

#include <algorithm>
#include <array>
#include <utility>

namespace slosh::codec {

void CellOrder::sort(const Snapshot& snapshot, double per_step, bool shell_only,
                     const std::vector<std::uint8_t>& without) {
  const std::size_t count = snapshot.positions.size();
  const bool choosy = shell_only && snapshot.shell.size() == count;
  ids.clear();
  for (auto& axis : raw_) axis.clear();
  for (std::size_t id = 0; id < count && ids.size() < kMaxParticles; ++id) {
    std::int32_t point[3];
    if (!is_drawn(snapshot, id) || (choosy && snapshot.shell[id] == 0) ||
        (id < without.size() && without[id] != 0) || !to_lattice(snapshot.positions[id], per_step, point))
      continue;
    ids.push_back(static_cast<std::uint32_t>(id));
    for (int a = 0; a < 3; ++a) raw_[a].push_back(point[a]);
  }
  for (int a = 0; a < 3; ++a) origin[a] = ids.empty() ? 0 : *std::min_element(raw_[a].begin(), raw_[a].end());
  entries_.resize(ids.size());
  spare_.resize(ids.size());
  std::uint64_t all = 0;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    const std::int32_t point[3] = {raw_[0][i], raw_[1][i], raw_[2][i]};
    entries_[i] = {morton(point, origin), static_cast<std::uint32_t>(i)};
    all |= entries_[i].code;
  }
  constexpr int kDigit = 11;
  for (int shift = 0; shift < 64 && all >> shift != 0; shift += kDigit) {
    std::array<std::uint32_t, 1 << kDigit> start{};
    for (const Entry& e : entries_) ++start[e.code >> shift & ((1 << kDigit) - 1)];
    std::uint32_t sum = 0;
    for (std::uint32_t& s : start) sum += std::exchange(s, sum);
    for (const Entry& e : entries_) spare_[start[e.code >> shift & ((1 << kDigit) - 1)]++] = e;
    entries_.swap(spare_);
  }
  for (auto& axis : at) axis.resize(ids.size());
  std::vector<std::uint32_t>& order = spare_ids_;
  order.resize(ids.size());
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const std::uint32_t from = entries_[i].id;
    order[i] = ids[from];
    for (int a = 0; a < 3; ++a) at[a][i] = raw_[a][from];
  }
  ids.swap(order);
}

}  // namespace slosh::codec
