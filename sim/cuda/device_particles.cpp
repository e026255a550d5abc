#include "sim/cuda/device_particles.h"

#include <array>
#include <vector>

#include "sim/cuda/solve_rows.h"

namespace slosh::cuda {

StepConstants step_constants(const RunConstants& c) {
  const CellGrid grid = c.grid.sliced(kSlices);
  return {grid,
          c.support_radius,
          grid.coarse_reach_squared(c.support_radius),
          c.force_scale,
          c.drag_shape,
          c.rest_number_density,
          c.rest_volume,
          static_cast<float>(c.plan.stiffness),
          static_cast<float>(c.plan.tension),
          c.gravity,
          c.correction};
}

void CellStarts::allocate(const CellGrid& grid, CallCheck& check) {
  starts_.allocate(grid.cell_count() + 1, check);
  filled_.allocate(CellTiles(grid).count, check);
}

void SortSpace::allocate(std::uint32_t largest_count, const CellGrid& grid, CallCheck& check) {
  retired_ = grid.retired_key();
  tiles_ = CellTiles(grid);
  counts_.allocate(retired_ + 1, check);
  in_tile_.allocate(tiles_.count, check);
  tile_start_.allocate(tiles_.count + 1, check);
  tickets_.allocate(largest_count, check);
  came_.allocate(largest_count, check);
}

void SortSpace::count_keys(const std::uint32_t* keys, std::uint32_t count, bool some_out, CellTable cells,
                           cudaStream_t stream) const {
  launch_count_keys(keys, count, retired_, some_out ? cells.start + retired_ : nullptr, view(), stream);
}

void SortSpace::find_cells(const std::uint32_t* keys, std::uint32_t count, CellTable cells, CallCheck& check,
                           cudaStream_t stream) {
  if (check.failed()) return;
  launch_find_cells(keys, count, retired_, tiles_, view(), cells, stream);
  check.launched("sort");
}

namespace {

FluidView view_of(const MovingPacks<DeviceBuffer>& packs) {
  FluidView view;
  for_each_pack([](auto, const auto& buffer, auto& pointer) { pointer = buffer.data(); }, packs, view);
  return view;
}

// Farther than any particle, and near enough for its square to be finite.
void put_far(float4* places, CallCheck& check) {
  std::array<float4, kNobodies> nobodies;
  nobodies.fill({1e18f, 1e18f, 1e18f, 0.0f});
  if (!check.failed())
    check.ok(cudaMemcpy(places, nobodies.data(), sizeof nobodies, cudaMemcpyHostToDevice), "upload");
}

}  // namespace

void FluidBuffers::allocate(std::size_t count, const RunConstants& constants, const CellGrid& grid,
                            CallCheck& check) {
  const std::size_t with_nobodies = count + kNobodies;
  for (MovingPacks<DeviceBuffer>& packs : packs_)
    for_each_pack(
        [&](auto pack, auto& buffer) {
          if (needs(constants.plan, need_of(pack))) buffer.allocate(with_nobodies, check);
        },
        packs);
  pressed_.allocate(with_nobodies, check);
  for (float4* places : {packs_[0].x.data(), packs_[1].x.data(), pressed_.data()})
    put_far(places + count, check);
  force_.allocate(count, check);
  starts_.allocate(grid, check);
  if (needs(constants.plan, ColumnNeed::kCorrected)) {
    push_a_.allocate(with_nobodies, check);
    push_b_.allocate(with_nobodies, check);
    drag_z_.allocate(with_nobodies, check);
    const std::uint32_t lanes = kTensorTeams.lanes(static_cast<std::uint32_t>(count));
    // A team's rows of cells do not share out evenly.
    const std::uint32_t room = row_room(constants.plan) / lanes / kListed * kListed + (lanes > 1 ? 8 : 0);
    const std::size_t threads = (count * lanes + 127) / 128 * 128;
    near_.allocate((threads + 32) * room / kListed, check);  // what is read ahead of a list's end is nobody's
    near_counts_.allocate(threads, check);
    coarse_.allocate(with_nobodies, check);
    view_.near = {room, near_.data(), near_counts_.data()};
  }
  if (needs(constants.plan, ColumnNeed::kSolved)) expansion_.allocate(count, check);
  if (constants.plan.passes_stress) {
    for (DeviceBuffer<float4>* rows : {&passed_x_, &passed_y_, &passed_z_})
      rows->allocate(with_nobodies, check);
    left_.allocate(with_nobodies, check);
  }
  if (needs(constants.plan, ColumnNeed::kHeat)) heating_.allocate(count, check);
  view_.count = static_cast<std::uint32_t>(count);
  view_.state = view_of(packs_[current_]);
  view_.coarse = coarse_.data();
  view_.pressed = pressed_.data();
  view_.push_a = push_a_.data();
  view_.push_b = push_b_.data();
  view_.drag_z = drag_z_.data();
  view_.expansion = expansion_.data();
  view_.passed_x = passed_x_.data();
  view_.passed_y = passed_y_.data();
  view_.passed_z = passed_z_.data();
  view_.left = left_.data();
  view_.heating = heating_.data();
  view_.force = force_.data();
  view_.cells = starts_.view();
  allow_viscosities(constants, check);
}

void FluidBuffers::allow_viscosities(const RunConstants& constants, CallCheck& check) {
  if (!constants.plan.has(PassId::kPairViscosity) || viscosity_.size() > 0) return;
  viscosity_.allocate(count() + kNobodies, check);
  view_.viscosity = viscosity_.data();
}

void FluidBuffers::write(const MovingPacks<PlainColumn>& packs, CallCheck& check, cudaStream_t stream) {
  for_each_pack(
      [&](auto, const auto& from, auto& buffer) {
        if (buffer.size() > 0) buffer.write(from, check, stream);
      },
      packs, packs_[current_]);
  some_out_ = false;
}

void FluidBuffers::sort(const StepConstants& constants, SortSpace& space, Keys keys, CallCheck& check,
                        cudaStream_t stream) {
  if (check.failed()) return;
  const FluidView from = view_.state;
  current_ = 1 - current_;
  view_.state = view_of(packs_[current_]);
  if (keys == Keys::kNotCounted) space.count_keys(from.key, count(), some_out_, view_.cells, stream);
  space.find_cells(from.key, count(), view_.cells, check, stream);
  if (check.failed()) return;
  some_out_ = true;
  launch_gather_fluid(constants, from, space.view(), view_, stream);
  check.launched("gathering fluid");
}

void SurfaceBuffers::allocate(const std::vector<SurfaceParticle>& particles, const CellGrid& grid,
                              CallCheck& check) {
  const std::uint32_t count = static_cast<std::uint32_t>(particles.size());
  if (count == 0) return;
  std::vector<float4> position;
  std::vector<float2> material;
  std::vector<float> reach;
  std::vector<std::uint16_t> body;
  for (const SurfaceParticle& p : particles) {
    position.push_back({p.position.x, p.position.y, p.position.z, p.pressure});
    material.push_back({p.volume, p.viscosity});
    reach.push_back(p.reach);
    body.push_back(p.body);
  }
  position_.upload(position, check);
  material_.upload(material, check);
  reach_.upload(reach, check);
  body_.upload(body, check);
  for (DeviceBuffer<float4>* buffer : {&placed_, &velocity_, &force_, &couple_, &sorted_x_, &sorted_v_}) {
    buffer->allocate(count, check);
  }
  for (DeviceBuffer<std::uint32_t>* buffer : {&key_, &sorted_key_, &order_}) buffer->allocate(count, check);
  drag_a_.allocate(count, check);
  drag_b_.allocate(count, check);
  viscosity_.allocate(count, check);
  sorted_reach_.allocate(count, check);
  sorted_body_.allocate(count, check);
  starts_.allocate(grid, check);
  local_view_ = {count,         position_.data(), material_.data(), reach_.data(),
                 body_.data(),  placed_.data(),   velocity_.data(), key_.data(),
                 force_.data(), couple_.data(),   drag_a_.data(),   drag_b_.data()};
  sorted_view_ = {count,
                  sorted_x_.data(),
                  sorted_v_.data(),
                  viscosity_.data(),
                  sorted_reach_.data(),
                  sorted_body_.data(),
                  sorted_key_.data(),
                  order_.data(),
                  starts_.view(),
                  upload_mirrors(particles, check)};
}

void SurfaceBuffers::replace(std::size_t first, std::span<const SurfaceParticle> particles, CallCheck& check,
                             cudaStream_t stream) {
  std::vector<float4> position;
  std::vector<float2> material;
  std::vector<float> reach;
  for (const SurfaceParticle& p : particles) {
    position.push_back({p.position.x, p.position.y, p.position.z, p.pressure});
    material.push_back({p.volume, p.viscosity});
    reach.push_back(p.reach);
  }
  position_.write_from(first, position, check, stream);
  material_.write_from(first, material, check, stream);
  reach_.write_from(first, reach, check, stream);
}

MirrorPlanes SurfaceBuffers::upload_mirrors(const std::vector<SurfaceParticle>& particles, CallCheck& check) {
  std::vector<float4> normal, bend_a;
  std::vector<float2> bend_b;
  bool any = false;
  for (const SurfaceParticle& p : particles) {
    const auto& [n, b] = p.mirror;
    any |= n != glm::vec3(0.0f);
    normal.push_back({n.x, n.y, n.z, 0.0f});
    bend_a.push_back({b.xx, b.xy, b.xz, b.yy});
    bend_b.push_back({b.yz, b.zz});
  }
  if (!any) return {};
  mirror_normal_.upload(normal, check);
  mirror_bend_a_.upload(bend_a, check);
  mirror_bend_b_.upload(bend_b, check);
  return {mirror_normal_.data(), mirror_bend_a_.data(), mirror_bend_b_.data()};
}

void SurfaceBuffers::place(const StepConstants& constants, const DeviceBody* bodies, SortSpace& space,
                           CallCheck& check, cudaStream_t stream) {
  if (count() == 0 || check.failed()) return;
  launch_place_surface(constants, local_view_, bodies, space.view(), stream);
  check.launched("placing body particles");
  space.find_cells(key_.data(), count(), sorted_view_.cells, check, stream);
  if (check.failed()) return;
  launch_gather_surface(constants, local_view_, space.view(), sorted_view_, stream);
  check.launched("gathering body particles");
}

}  // namespace slosh::cuda
