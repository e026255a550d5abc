#include "render/headset.h"

#include "render/xr/session.h"

namespace slosh {
namespace {

class OpenXrHeadset final : public Headset {
 public:
  OpenXrHeadset(const HeadsetOptions& options, std::unique_ptr<xr::Runtime> runtime)
      : options_(options), runtime_(std::move(runtime)), description_(runtime_->description()) {}
  ~OpenXrHeadset() override { OpenXrHeadset::stop(); }

  std::string description() const override { return description_; }
  bool takes_window() const override { return runtime_ && runtime_->has_glx(); }
  bool takes_headless() const override { return runtime_ && runtime_->has_egl(); }

  Result<bool> start(Context& context) override {
    stop();
    if (!runtime_) {
      auto found = xr::Runtime::find();
      if (!found) return found.error();
      runtime_ = std::move(found.value());
      description_ = runtime_->description();
    }
    auto session = xr::Session::begin(*runtime_, context, *hands_, options_);
    if (!session) {
      runtime_.reset();
      return session.error();
    }
    session_ = std::move(session.value());
    return true;
  }
  void stop() override {
    if (!session_) return;
    session_.reset();
    runtime_.reset();
  }

  HeadsetState poll() override { return session_ ? session_->poll() : HeadsetState::kLost; }
  bool frame(const std::function<HeadsetPlaces(const Pose& head)>& places,
             const std::function<void(const HeadsetPictures&)>& draw) override {
    return session_ && session_->frame(places, draw);
  }
  std::optional<Pose> head() const override { return session_ ? session_->head() : std::nullopt; }
  bool floor_known() const override { return session_ && session_->floor_known(); }
  double period() const override { return session_ ? session_->period() : 0.0; }
  std::string take_problem() override { return session_ ? session_->take_problem() : std::string(); }
  std::shared_ptr<HeadsetHands> hands() override { return hands_; }

 private:
  HeadsetOptions options_;
  std::unique_ptr<xr::Runtime> runtime_;
  std::string description_;
  std::shared_ptr<xr::Hands> hands_ = std::make_shared<xr::Hands>();
  std::unique_ptr<xr::Session> session_;  // before the runtime
};

}  // namespace

Result<std::unique_ptr<Headset>> Headset::find(const HeadsetOptions& options) {
  auto runtime = xr::Runtime::find();
  if (!runtime) return runtime.error();
  return std::unique_ptr<Headset>(std::make_unique<OpenXrHeadset>(options, std::move(runtime.value())));
}

}  // namespace slosh
