// What a particle costs on the wire and how long coding takes: two flows of 32,768 particles at 60 Hz, every
// frame through encoder and decoder, beside general coders on the same lattice points.
// tests/bench/README.md says how to read it.
#include <zstd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <numeric>

#include "net/codec/lattice.h"
#include "net/codec/snapshot_codec.h"
#include "sim/shell.h"
#include "tests/bench/codec_scenes.h"
#ifdef SLOSH_HAS_MESHOPT
#include <meshoptimizer.h>
#endif
#ifdef SLOSH_HAS_DRACO
#include <draco/compression/encode.h>
#include <draco/point_cloud/point_cloud_builder.h>
#endif
#ifdef SLOSH_HAS_MASK
#include "tests/bench/codec_mask.h"
#endif

namespace {

using namespace slosh;

double seconds_now() {
  return 1e-9 * static_cast<double>(std::chrono::steady_clock::now().time_since_epoch().count());
}

/// Of this thread: what else the machine did meanwhile does not count.
double cpu_seconds_now() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

double at_share(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  const auto nth = values.begin() + static_cast<long>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), nth, values.end());
  return *nth;
}

class Table {
 public:
  void add(const std::string& flow, const std::string& what, const std::string& quantity, double value) {
    std::printf("%-9s %-34s %-28s %.4g\n", flow.c_str(), what.c_str(), quantity.c_str(), value);
    std::fflush(stdout);
    lines_ += flow + ',' + what + ',' + quantity + ',' + std::to_string(value) + '\n';
  }
  bool write(const std::string& file) const {
    std::ofstream out(file);
    out << "flow,what,quantity,value\n" << lines_;
    return out.good();
  }

 private:
  std::string lines_;
};

/// Encodes and decodes all frames. Returns bytes a particle of the whole fluid; false in `good` when a
/// picture came out incomplete or refused.
double bench_codec(Table& table, const std::string& flow, const std::vector<Snapshot>& frames,
                   const CodecOptions& options, bool& good, std::vector<DecodedFrame>* shown) {
  SnapshotEncoder encoder(options);
  SnapshotDecoder decoder;
  const double count = static_cast<double>(frames.front().positions.size());
  std::vector<double> bytes, encode, encode_key, encode_key_cpu, decode;
  std::size_t key_bytes = 0;
  for (const Snapshot& frame : frames) {
    const double start = seconds_now(), cpu_start = cpu_seconds_now();
    const EncodedFrame& encoded = encoder.encode(frame, 0);
    (encoded.key ? encode_key : encode).push_back(1e3 * (seconds_now() - start));
    if (encoded.key) encode_key_cpu.push_back(1e3 * (cpu_seconds_now() - cpu_start));
    bytes.push_back(static_cast<double>(encoded.bytes));
    std::size_t of_key = 0;
    for (const Piece& piece : encoded.pieces)
      of_key += piece.epoch == encoded.epoch ? piece.bytes->size() : 0;
    if (encoded.key) key_bytes = std::max(key_bytes, of_key);
    const double then = seconds_now();
    for (const Piece& piece : encoded.pieces) good &= !decoder.take(*piece.bytes);
    if (!encoded.key) decode.push_back(1e3 * (seconds_now() - then));
    std::optional<DecodedFrame> newest;
    while (auto got = decoder.next()) {
      good &= got->complete == 1.0;
      newest = std::move(got);
    }
    if (shown) shown->push_back(newest.value_or(DecodedFrame{}));
  }
  const double mean =
      std::accumulate(bytes.begin(), bytes.end(), 0.0) / (count * static_cast<double>(bytes.size()));
  const std::string what = options.shell_only ? "slosh, shell only" : "slosh";
  table.add(flow, what, "bytes_per_particle", mean);
  table.add(flow, what, "bytes_per_particle_p99_frame", at_share(bytes, 0.99) / count);
  table.add(flow, what, "largest_key_frame_bytes", static_cast<double>(key_bytes));
  table.add(flow, what, "encode_ms_p50", at_share(encode, 0.5));
  table.add(flow, what, "encode_ms_best", at_share(encode, 0.0));
  table.add(flow, what, "encode_key_ms_p50", at_share(encode_key, 0.5));
  table.add(flow, what, "encode_key_cpu_ms_p50", at_share(encode_key_cpu, 0.5));
  table.add(flow, what, "decode_ms_p50", at_share(decode, 0.5));
  table.add(flow, what, "decode_ms_best", at_share(decode, 0.0));
  return mean;
}

/// Lattice points in Morton order, 16 bits an axis from the smallest on.
std::vector<std::uint16_t> sorted_points(const Snapshot& s, double tolerance) {
  std::vector<std::array<std::int32_t, 3>> points;
  std::int32_t origin[3] = {1 << 30, 1 << 30, 1 << 30};
  for (const glm::vec3& p : s.positions) {
    std::array<std::int32_t, 3> at{};
    if (!codec::to_lattice(p, 0.5 / tolerance, at.data())) continue;
    points.push_back(at);
    for (int a = 0; a < 3; ++a) origin[a] = std::min(origin[a], at[static_cast<std::size_t>(a)]);
  }
  std::sort(points.begin(), points.end(), [&](const auto& x, const auto& y) {
    return codec::morton(x.data(), origin) < codec::morton(y.data(), origin);
  });
  std::vector<std::uint16_t> out;
  for (const auto& p : points) {
    for (std::size_t a = 0; a < 3; ++a) out.push_back(static_cast<std::uint16_t>(p[a] - origin[a]));
  }
  return out;
}

struct Other {
  std::vector<double> bytes, ms;
  void report(Table& table, const std::string& flow, const std::string& what, double count) const {
    if (bytes.empty()) return;
    table.add(flow, what, "bytes_per_particle",
              std::accumulate(bytes.begin(), bytes.end(), 0.0) / (count * static_cast<double>(bytes.size())));
    table.add(flow, what, "encode_ms_p50", at_share(ms, 0.5));
  }
};

#ifdef SLOSH_HAS_DRACO
std::size_t draco_size(const std::vector<std::uint16_t>& points, int method) {
  const auto count = static_cast<std::uint32_t>(points.size() / 3);
  draco::PointCloudBuilder builder;
  builder.Start(count);
  const int id = builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_UINT32);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t at[3] = {points[3 * i], points[3 * i + 1], points[3 * i + 2]};
    builder.SetAttributeValueForPoint(id, draco::PointIndex(i), at);
  }
  const auto cloud = builder.Finalize(false);
  draco::Encoder encoder;
  encoder.SetEncodingMethod(method);
  encoder.SetSpeedOptions(5, 5);
  draco::EncoderBuffer buffer;
  return encoder.EncodePointCloudToBuffer(*cloud, &buffer).ok() ? buffer.size() : 0;
}
#endif

/// Each frame by itself, every tenth one. Times are without the sorting.
void bench_others(Table& table, const std::string& flow, const std::vector<Snapshot>& frames) {
  Other zstd, meshopt, kd_tree, sequential;
  for (std::size_t f = 0; f < frames.size(); f += 10) {
    const std::vector<std::uint16_t> points = sorted_points(frames[f], 0.001);
    const auto timed = [](Other& other, auto&& size) {
      const double start = seconds_now();
      other.bytes.push_back(static_cast<double>(size()));
      other.ms.push_back(1e3 * (seconds_now() - start));
    };
    timed(zstd, [&] {
      std::vector<char> out(ZSTD_compressBound(2 * points.size()));
      return ZSTD_compress(out.data(), out.size(), points.data(), 2 * points.size(), 3);
    });
#ifdef SLOSH_HAS_MESHOPT
    timed(meshopt, [&] {
      const std::size_t count = points.size() / 3;
      std::vector<std::uint16_t> rows(4 * count);
      for (std::size_t i = 0; i < count; ++i) std::copy_n(&points[3 * i], 3, &rows[4 * i]);
      std::vector<unsigned char> out(meshopt_encodeVertexBufferBound(count, 8));
      return meshopt_encodeVertexBuffer(out.data(), out.size(), rows.data(), count, 8);
    });
#endif
#ifdef SLOSH_HAS_DRACO
    timed(kd_tree, [&] { return draco_size(points, draco::POINT_CLOUD_KD_TREE_ENCODING); });
    timed(sequential, [&] { return draco_size(points, draco::POINT_CLOUD_SEQUENTIAL_ENCODING); });
#endif
  }
  const double count = static_cast<double>(frames.front().positions.size());
  zstd.report(table, flow, "zstd 3 on sorted u16", count);
  meshopt.report(table, flow, "meshoptimizer on sorted u16", count);
  kd_tree.report(table, flow, "draco kd-tree", count);
  sequential.report(table, flow, "draco sequential", count);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Size and speed of the snapshot codec"};
  std::string csv, cache;
  double tolerance = 0.001;
  int side = 32;
  bool mask = false;
  app.add_option("--csv", csv, "also write the results here");
  app.add_option("--cache", cache, "folder that keeps the simulated frames for the next time (none)");
  app.add_option("--tolerance", tolerance, "m")->check(CLI::Range(1e-5, 0.01));
  app.add_option("--side", side, "particles along an edge of the fluid")->check(CLI::Range(8, 64));
  app.add_flag("--mask", mask, "draw full and shell-only pictures and compare where fluid is seen");
  CLI11_PARSE(app, argc, argv);
  Table table;
  bool good = true;
  for (const bench::Flow flow : {bench::Flow::kStirred, bench::Flow::kDamBreak}) {
    bench::FlowOptions options;
    options.flow = flow;
    options.side = side;
    options.seconds = flow == bench::Flow::kStirred ? 4.0 : 3.0;
    const std::string name = flow == bench::Flow::kStirred ? "stirred" : "dam break";
    auto recorded = bench::record_flow(
        options, cache.empty()
                     ? std::filesystem::path()
                     : std::filesystem::path(cache) / (name.substr(0, 3) + std::to_string(side) + ".flow"));
    if (!recorded) return std::fprintf(stderr, "%s\n", recorded.error().text().c_str()), 1;
    std::vector<Snapshot>& frames = recorded.value().frames;
    std::printf("%s: %s, spacing %.3g m, %zu particles, %zu frames at %.0f Hz, within %.3g m\n", name.c_str(),
                recorded.value().geometry.c_str(), options.spacing, frames.front().positions.size(),
                frames.size(), options.snapshot_rate, tolerance);
    std::vector<double> find;
    for (Snapshot& frame : frames) {
      const double start = seconds_now();
      find_shell(frame.positions, frame.fluid_index, options.spacing, frame.shell);
      find.push_back(1e3 * (seconds_now() - start));
    }
    CodecOptions codec;
    codec.tolerance = tolerance;
    codec.spacing = options.spacing;
    std::vector<DecodedFrame> all, shell;
    const double full = bench_codec(table, name, frames, codec, good, mask ? &all : nullptr);
    codec.shell_only = true;
    const double part = bench_codec(table, name, frames, codec, good, mask ? &shell : nullptr);
    table.add(name, "slosh, shell only", "percent_of_full", 100.0 * part / full);
    table.add(name, "slosh, shell only", "find_shell_ms_p50", at_share(find, 0.5));
#ifdef SLOSH_HAS_MASK
    if (mask) {
      const auto differing = bench::compare_masks(all, shell, options.spacing);
      if (!differing) return std::fprintf(stderr, "%s\n", differing.error().text().c_str()), 1;
      const std::vector<double>& percent = differing.value();
      const auto within = std::count_if(percent.begin(), percent.end(), [](double p) { return p <= 1.0; });
      const auto count = static_cast<double>(percent.size());
      const std::string what = "slosh, shell only";
      table.add(name, what, "mask_differs_percent_mean",
                std::accumulate(percent.begin(), percent.end(), 0.0) / count);
      table.add(name, what, "mask_differs_percent_p95", at_share(percent, 0.95));
      table.add(name, what, "mask_differs_percent_worst", at_share(percent, 1.0));
      table.add(name, what, "mask_within_1_percent_of_frames", 100.0 * static_cast<double>(within) / count);
    }
#endif
    bench_others(table, name, frames);
  }
  if (!good) std::fprintf(stderr, "a picture came out incomplete\n");
  if (!csv.empty() && !table.write(csv)) {
    std::fprintf(stderr, "%s: cannot be written\n", csv.c_str());
    good = false;
  }
  return good ? 0 : 1;
}
