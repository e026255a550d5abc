#include "tests/bench/render_wishes.h"

namespace slosh::bench {

void say_options(CLI::App& app, Wishes& wishes) {
  app.add_option("--width", wishes.width, "pixels")->check(CLI::Range(16, 8192))->capture_default_str();
  app.add_option("--height", wishes.height, "pixels")->check(CLI::Range(16, 8192))->capture_default_str();
  app.add_option("--particles", wishes.particles, "in a broken dam, about")
      ->check(CLI::Range(1, 4'000'000))
      ->capture_default_str();
  app.add_option("--frames", wishes.frames, "measured, after two that are not")
      ->check(CLI::Range(1, 10'000))
      ->capture_default_str();
  app.add_option("--threads", wishes.threads, "of a processor that draws")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  app.add_flag("--batter", wishes.batter, "an opaque fluid instead of water");
  app.add_flag("--juice", wishes.juice, "a cloudy one");
  app.add_flag("--mix", wishes.mix, "a cloudy one into which an opaque one runs");
  app.add_flag("--hard", wishes.hard, "fluids meet in hard outlines");
  app.add_flag("--basin", wishes.basin, "a still basin with a post behind it, in place of the broken dam");
  app.add_flag("--srgb", wishes.srgb, "the plain sRGB display in place of ACES");
  app.add_flag("--table", wishes.table, "colours by the baked table alone");
  app.add_flag("--text", wishes.text, "colours by OpenColorIO's own shader text");
  app.add_flag("--caustics", wishes.caustics, "light focused by the fluid's surface, with --full");
  app.add_flag("--no-bodies", wishes.no_bodies, "the fluid mirrors the room alone");
  app.add_flag("--paper", wishes.paper, "the paper's section 5");
  app.add_flag("--flow", wishes.flow, "curvature flow");
  app.add_flag("--full", wishes.full, "full quality: what a film has");
  app.add_flag("--hud", wishes.hud, "arrows and a panel over it");
  app.add_flag("--bucket", wishes.bucket, "the tank is no glass");
  app.add_flag("--moving", wishes.moving, "a ball moves from picture to picture, so that no shadow is kept");
  app.add_flag("--on-gpu", wishes.on_gpu, "particles lie on the GPU already, where CUDA puts them");
  app.add_option("--detail", wishes.detail, "a ball more, of four times the square of this triangles")
      ->check(CLI::Range(2, 1000));
  app.add_option("--warm", wishes.warm,
                 "pictures more before each that is measured: a GPU that waits slows down")
      ->check(CLI::Range(0, 1000));
  app.add_flag("--stereo", wishes.stereo, "both eyes against one as well, each of that size, with the HUD");
  app.add_option("--pixels", wishes.pixels,
                 "a processor's path (fragments), a GPU's (compute), or both in turn; still: by fragments, "
                 "all anew and with what stands still kept, in turn")
      ->check(CLI::IsMember({"both", "fragments", "compute", "still"}))
      ->capture_default_str();
  app.add_option("--environment", wishes.environment, "the room: FILE.hdr or studio");
  app.add_option("--out", wishes.out, "the picture, FILE.png");
  app.add_option("--reference", wishes.reference,
                 "no times: the picture by this many paths a pixel, into --out")
      ->check(CLI::Range(1, 100'000))
      ->needs("--out");
}

}  // namespace slosh::bench
