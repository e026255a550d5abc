// Pairs of particles written down once a sub-step, for all iterations of a solve.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "sim/cpu/four_vectors.h"
#include "sim/cpu/simd.h"

namespace slosh {

/// A vector of a particle's in 16 bytes, so that a neighbour's is one load. `w` means nothing unless said.
struct alignas(16) Vector4 {
  float x = 0.0f, y = 0.0f, z = 0.0f, w = 0.0f;
};

/// A symmetric tensor as a walk over rows takes it, and what else is asked for with it: the fourths go into
/// no product.
struct alignas(32) PressureTensor {
  float xx, yy, zz, volume;
  float xy, yz, xz, viscosity;
};

/// For each of a set of particles its pairs, a weight each: pressure pairs (s = −W'/r without the kernel's
/// constant, so that g = s d), viscous pairs (q, kg/m²: q d (d · v)); d is from the other to the particle and
/// comes from where the two are. 8 bytes a pair. Particles go by fours, a pair of each side by side: no row
/// has a sum over lanes of its own.
class PairRows {
  struct Chunk;

 public:
  struct alignas(8) Pair {
    float weight;
    std::int32_t other;
  };
  static constexpr std::uint32_t kTogether = 4;
  /// Of a pair of each.
  using Others = std::array<std::int32_t, kTogether>;

  /// Up to four particles one behind the other.
  struct Group {
    std::uint32_t first = 0, count = 0;
    std::uint32_t begin = 0, end = 0;  ///< its pairs, of the chunk's
  };

  /// Begins anew, for particles in `chunks` chunks of cells.
  void clear(std::size_t chunks);
  std::size_t chunks() const { return used_; }

  class Walk;
  /// One chunk's rows as they are being written, particle after particle; chunks may be written beside each
  /// other.
  class Writer {
   public:
    Writer(PairRows& rows, std::size_t chunk) : chunk_(rows.chunks_[chunk]) {}
    ~Writer() {
      if (waits()) put_group();
    }
    Writer(const Writer&) = delete;
    Writer& operator=(const Writer&) = delete;
    /// The row of p comes now, until end().
    void begin(std::uint32_t p) {
      if (group_.count == 0) group_.first = p;
      count_ = 0;
      make_room();
    }
    /// The picked ones of a batch of particles that begins at `first`.
    void add(std::uint32_t first, FloatBatch weights, PickedLanes picked) {
      if (count_ + 2 * kLanes > row_->other.size()) make_room();
      store_picked(weights, picked, row_->weight.data() + count_);
      store_picked_indices(first, picked, row_->other.data() + count_);
      count_ += static_cast<std::size_t>(count_of(picked));
    }
    void end() {
      row_->count = count_;
      if (++group_.count == kTogether) put_group();
    }
    /// The same where weights are found group by group: who is in p's row goes where this says, at most
    /// `most` and a batch behind them, and then end_at(). Of each group put_weighed().
    /// `ahead`: of how many the rows have begun and not ended.
    std::int32_t* begin(std::uint32_t p, std::size_t most, std::uint32_t ahead = 0) {
      if (group_.count + ahead == 0) group_.first = p;
      std::vector<std::int32_t>& other = rows_[group_.count + ahead].other;
      if (most + kLanes > other.size()) other.resize(most + kLanes);
      return other.data();
    }
    /// True where that was a group's last.
    bool end_at(const std::int32_t* end) {
      OneRow& row = rows_[group_.count];
      row.count = static_cast<std::size_t>(end - row.other.data());
      return ++group_.count == kTogether;
    }
    /// How many rows the group has left.
    std::uint32_t room() const { return kTogether - group_.count; }
    /// Rows are waiting for put_weighed().
    bool waits() const { return group_.count > 0; }
    /// The first of those whose rows wait.
    std::uint32_t first() const { return group_.first; }
    /// f(others), of a pair of each, gives their weights, each four times. Rows are filled up with `nobody`,
    /// who must weigh nothing. Returns the group.
    template <class F>
    Walk put_weighed(std::uint32_t nobody, F&& f);
    /// Room for a group's pairs of other rows, to be written again as they lie there with weights of their
    /// own. Then begin() … end() of each of its particles, for what goes behind them.
    Pair* take(const Walk& walk);

   private:
    struct OneRow {
      std::vector<std::int32_t> other;
      std::vector<float> weight;
      std::size_t count = 0;
    };
    __attribute__((noinline)) void make_room();
    __attribute__((noinline)) void put_group();
    void close_group(std::size_t pairs) {
      group_.begin = static_cast<std::uint32_t>(chunk_.size);
      chunk_.size += pairs;
      group_.end = static_cast<std::uint32_t>(chunk_.size);
      chunk_.groups.push_back(group_);
      group_ = {};
      taken_ = 0;
    }

    Chunk& chunk_;
    Group group_;
    OneRow rows_[kTogether];
    OneRow* row_ = rows_;
    std::size_t taken_ = 0;  // pairs that lie there already
    std::size_t count_ = 0;  // of one row; there is room for two batches behind it
  };

  /// f(walk) for the groups of a chunk.
  template <class F>
  void for_each_group(std::size_t chunk, F&& f) const {
    const Chunk& c = chunks_[chunk];
    for (const Group& group : c.groups) f(Walk{group, c.pairs.data()});
  }

  /// A group's rows. What has an entry a particle has four entries more than there are particles.
  class Walk {
   public:
    Walk(const Group& group, const Pair* pairs)
        : first(group.first), count(group.count), begin_(pairs + group.begin), end_(pairs + group.end) {}
    const std::uint32_t first, count;
    /// Of all four, with what fills them up.
    std::size_t pairs() const { return static_cast<std::size_t>(end_ - begin_); }

    /// Of each of the group the sum of T g over its row, T each other's of `tensors`, with everybody at
    /// `places`; fourths mean nothing.
    Sixteen push(const Vector4* places, const PressureTensor* tensors) const {
      Sixteen straight = {}, turning = {}, back = {};
      for_each_pair(places, [&](Sixteen g, const Pair* four) {
        const Sixteen odd = of_others<8>(&tensors->xy, four);
        straight += of_others<8>(&tensors->xx, four) * g;
        turning += odd * turned(g);
        back += odd * g;
      });
      return straight + turning + turned_back(back);
    }
    /// The sum of g · (T v), as the three parts of a sum, v each other's of `velocities`, T one's own of
    /// `tensors`.
    Sixteen flow(const Vector4* places, const PressureTensor* tensors, const Vector4* velocities) const {
      Sixteen even = {}, odd = {}, other_odd = {};
      for_each_pair(places, [&](Sixteen g, const Pair* four) {
        const Sixteen v = of_others<4>(&velocities->x, four);
        even += g * v;
        odd += turned(g) * v;
        other_odd += g * turned(v);
      });
      return of_group<8>(&tensors[first].xx) * even + of_group<8>(&tensors[first].xy) * (odd + other_odd);
    }
    /// The sum of g ⊗ g times the fourth of each other's of `velocities`: xx, yy, zz in `even`, xy, yz, xz in
    /// `odd`.
    struct SumOfSquares {
      Sixteen even = {}, odd = {};
    };
    SumOfSquares squares(const Vector4* places, const Vector4* velocities) const {
      SumOfSquares sum;
      for_each_pair(places, [&](Sixteen g, const Pair* four) {
        const Sixteen weighed = fourths(of_others<4>(&velocities->x, four)) * g;
        sum.even += weighed * g;
        sum.odd += weighed * turned(g);
      });
      return sum;
    }
    /// What `shape` gives over r² for pairs at `d` from each other, m. Below 0 from h on.
    static Sixteen drag_shape(Sixteen d, float h, const DragShape<float>& shape) {
      const Sixteen r_squared = sums(d * d) + h * h * 1e-12f, inverse_r = inverse_roots(r_squared);
      const Sixteen reach = h - r_squared * inverse_r;
      return (reach * (shape.growth * reach + shape.level)) * (inverse_r * inverse_r);
    }
    /// The sum of q d (d · (v − one's own)), v each other's of `velocities`, in rows of viscous pairs.
    Sixteen dragged(const Vector4* places, const Vector4* velocities) const {
      const Sixteen own = of_group<4>(&velocities[first].x);
      // A pair's two viscous forces are exactly opposite, so momentum is conserved to what sums round: that
      // is carried along.
      Sixteen sum = {}, lost = {};
      for_each_way(places, [&](Sixteen d, const Pair* four) {
        const Sixteen along = sums(d * (of_others<4>(&velocities->x, four) - own));
        const Sixteen term = (each_even_four_times(&four->weight) * along) * d - lost;
        const Sixteen next = sum + term;
        lost = (next - sum) - term;
        sum = next;
      });
      return sum - lost;
    }
    /// The sum of q d ⊗ d over each row.
    SumOfSquares rates(const Vector4* places) const {
      SumOfSquares sum;
      for_each_way(places, [&](Sixteen d, const Pair* four) {
        const Sixteen weighed = each_even_four_times(&four->weight) * d;
        sum.even += weighed * d;
        sum.odd += weighed * turned(d);
      });
      return sum;
    }
    /// Four floats of each of the group, `stride` floats from one particle to the next.
    template <std::size_t stride>
    static Sixteen of_group(const float* v) {
      return side_by_side(v, v + stride, v + 2 * stride, v + 3 * stride);
    }
    /// f(d, pairs) of a pair of each; d's fourths are 0.
    template <class F>
    void for_each_way(const Vector4* places, F&& f) const {
      const Sixteen self = of_group<4>(&places[first].x);
      for (const Pair* four = begin_; four < end_; four += kTogether)
        f(self - of_others<4>(&places->x, four), four);
    }
    /// Four floats of each other, of `all` that have `stride` each.
    template <std::size_t stride>
    static Sixteen of_others(const float* all, const Others& others) {
      const auto at = [&](std::size_t k) { return all + stride * static_cast<std::uint32_t>(others[k]); };
      return side_by_side(at(0), at(1), at(2), at(3));
    }
    template <std::size_t stride>
    static Sixteen of_others(const float* all, const Pair* four) {
      return of_others<stride>(all, Others{four[0].other, four[1].other, four[2].other, four[3].other});
    }

   private:
    // f(g, pairs) as for_each_way().
    template <class F>
    void for_each_pair(const Vector4* places, F&& f) const {
      for_each_way(places,
                   [&](Sixteen d, const Pair* four) { f(each_even_four_times(&four->weight) * d, four); });
    }
    const Pair *begin_, *end_;
  };

 private:
  struct Chunk {
    Column<Pair> pairs;
    std::size_t size = 0;  // of what is written
    std::vector<Group> groups;

    void make_room(std::size_t more);
  };

  std::vector<Chunk> chunks_;
  std::size_t used_ = 0;
};

template <class F>
PairRows::Walk PairRows::Writer::put_weighed(std::uint32_t nobody, F&& f) {
  std::size_t longest = 0;
  for (std::uint32_t a = group_.count; a < kTogether; ++a) rows_[a].count = 0;
  for (const OneRow& row : rows_) longest = std::max(longest, row.count);
  const std::int32_t* others[kTogether];
  for (std::uint32_t a = 0; a < kTogether; ++a) {
    OneRow& row = rows_[a];
    if (row.other.size() < longest) row.other.resize(longest);
    std::fill(row.other.begin() + static_cast<std::ptrdiff_t>(row.count),
              row.other.begin() + static_cast<std::ptrdiff_t>(longest), static_cast<std::int32_t>(nobody));
    others[a] = row.other.data();
  }
  chunk_.make_room(kTogether * longest);
  Pair* to = chunk_.pairs.data() + chunk_.size;
  for (std::size_t k = 0; k < longest; ++k, to += kTogether) {
    const Others four{others[0][k], others[1][k], others[2][k], others[3][k]};
    put_pairs(f(four), four.data(), to);
  }
  close_group(kTogether * longest);
  return {chunk_.groups.back(), chunk_.pairs.data()};
}

}  // namespace slosh
