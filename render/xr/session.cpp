#include "render/xr/session.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "render/xr/binding.h"

namespace slosh::xr {
namespace {

constexpr XrViewConfigurationType kStereo = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
constexpr int kMaxRefused = 30;  // frames in a row

}  // namespace

Result<std::unique_ptr<Session>> Session::begin(const Runtime& runtime, const Context& context, Hands& hands,
                                                const HeadsetOptions& options) {
  Result<XrSession> handle = make_session(runtime, context);
  if (!handle) return handle.error();
  std::unique_ptr<Session> session(new Session(runtime, hands, options));
  session->handle_ = handle.value();
  Result<bool> made = session->make_room();
  if (made) made = session->make_swapchains();
  if (made) made = hands.attach(runtime, session->handle_, session->room_);
  if (!made) return made.error();
  return session;
}

Session::~Session() {
  hands_.detach();
  panel_ = {};
  eyes_ = {};
  if (room_ != XR_NULL_HANDLE) xrDestroySpace(room_);
  if (handle_ != XR_NULL_HANDLE) xrDestroySession(handle_);
}

Result<bool> Session::make_room() {
  std::uint32_t count = 0;
  XrResult result = xrEnumerateReferenceSpaces(handle_, 0, &count, nullptr);
  std::vector<XrReferenceSpaceType> kinds(count);
  if (XR_SUCCEEDED(result)) result = xrEnumerateReferenceSpaces(handle_, count, &count, kinds.data());
  if (XR_FAILED(result)) return failed("xrEnumerateReferenceSpaces", result);
  floor_known_ = std::ranges::find(kinds, XR_REFERENCE_SPACE_TYPE_STAGE) != kinds.end();
  auto info = typed<XrReferenceSpaceCreateInfo>(XR_TYPE_REFERENCE_SPACE_CREATE_INFO);
  info.referenceSpaceType = floor_known_ ? XR_REFERENCE_SPACE_TYPE_STAGE : XR_REFERENCE_SPACE_TYPE_LOCAL;
  info.poseInReferenceSpace = no_move();
  result = xrCreateReferenceSpace(handle_, &info, &room_);
  if (XR_FAILED(result)) return failed("xrCreateReferenceSpace", result);
  return true;
}

Result<bool> Session::make_swapchains() {
  const XrInstance instance = runtime_.instance();
  std::array<XrViewConfigurationView, 2> views{};
  for (XrViewConfigurationView& view : views) view.type = XR_TYPE_VIEW_CONFIGURATION_VIEW;
  std::uint32_t count = 0;
  XrResult result =
      xrEnumerateViewConfigurationViews(instance, runtime_.system(), kStereo, 2, &count, views.data());
  if (XR_FAILED(result) || count != 2)
    return Error{"headset", "the headset has no picture for two eyes (" + result_name(result) + ")", ""};
  // One size for both: the renderer's own buffers are kept from eye to eye.
  glm::ivec2 size(1);
  for (const XrViewConfigurationView& view : views) {
    const glm::dvec2 wanted =
        options_.resolution * glm::dvec2(view.recommendedImageRectWidth, view.recommendedImageRectHeight);
    const glm::ivec2 most(view.maxImageRectWidth, view.maxImageRectHeight);
    size = glm::max(size, glm::min(glm::ivec2(glm::round(wanted)), most));
  }
  for (Swapchain& eye : eyes_) {
    Result<Swapchain> made = Swapchain::create(handle_, size);
    if (!made) return made.error();
    eye = std::move(made.value());
  }
  Result<Swapchain> panel = Swapchain::create(handle_, options_.panel_size);
  if (!panel) return panel.error();
  panel_ = std::move(panel.value());

  XrEnvironmentBlendMode first = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  result = xrEnumerateEnvironmentBlendModes(instance, runtime_.system(), kStereo, 0, &count, nullptr);
  std::vector<XrEnvironmentBlendMode> modes(count);
  if (XR_SUCCEEDED(result) && count > 0)
    result =
        xrEnumerateEnvironmentBlendModes(instance, runtime_.system(), kStereo, count, &count, modes.data());
  if (XR_SUCCEEDED(result) && !modes.empty()) first = modes.front();
  // What one sees through comes with a mode of its own; the studio about the scene is a picture as it is.
  blend_ = std::ranges::find(modes, XR_ENVIRONMENT_BLEND_MODE_OPAQUE) != modes.end()
               ? XR_ENVIRONMENT_BLEND_MODE_OPAQUE
               : first;
  return true;
}

HeadsetState Session::poll() {
  while (state_ != HeadsetState::kLost) {
    auto event = typed<XrEventDataBuffer>(XR_TYPE_EVENT_DATA_BUFFER);
    const XrResult result = xrPollEvent(runtime_.instance(), &event);
    if (result == XR_EVENT_UNAVAILABLE) break;
    if (XR_FAILED(result)) {
      problem_ = failed("xrPollEvent", result).text();
      state_ = HeadsetState::kLost;
      break;
    }
    take_event(event);
  }
  return state_;
}

void Session::take_event(const XrEventDataBuffer& event) {
  if (event.type == XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING) {
    problem_ = "headset: the runtime is going away; the run goes on without it";
    state_ = HeadsetState::kLost;
  } else if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
    const auto& changed = reinterpret_cast<const XrEventDataSessionStateChanged&>(event);
    if (changed.session == handle_) enter(changed.state);
  }
}

void Session::enter(XrSessionState state) {
  switch (state) {
    case XR_SESSION_STATE_READY: {
      auto info = typed<XrSessionBeginInfo>(XR_TYPE_SESSION_BEGIN_INFO);
      info.primaryViewConfigurationType = kStereo;
      const XrResult result = xrBeginSession(handle_, &info);
      running_ = XR_SUCCEEDED(result);
      if (!running_) problem_ = failed("xrBeginSession", result).text();
      state_ = running_ ? HeadsetState::kHidden : HeadsetState::kLost;
      return;
    }
    case XR_SESSION_STATE_SYNCHRONIZED:
      state_ = HeadsetState::kHidden;
      return;
    case XR_SESSION_STATE_VISIBLE:
      state_ = HeadsetState::kVisible;
      return;
    case XR_SESSION_STATE_FOCUSED:
      state_ = HeadsetState::kFocused;
      return;
    case XR_SESSION_STATE_STOPPING:
      if (std::exchange(running_, false)) xrEndSession(handle_);
      state_ = HeadsetState::kAway;
      return;
    case XR_SESSION_STATE_EXITING:
      state_ = HeadsetState::kEnded;
      return;
    case XR_SESSION_STATE_LOSS_PENDING:
      problem_ = "headset: the runtime lost it; the run goes on without it";
      state_ = HeadsetState::kLost;
      return;
    default:
      state_ = HeadsetState::kAway;
      return;
  }
}

bool Session::refused(const char* call, XrResult result) {
  const bool gone = result == XR_ERROR_SESSION_LOST || result == XR_ERROR_INSTANCE_LOST;
  if (refused_in_a_row_++ == 0 || gone) problem_ = failed(call, result).text();
  if (gone || refused_in_a_row_ >= kMaxRefused) state_ = HeadsetState::kLost;
  return false;
}

bool Session::locate_eyes(XrTime time, std::array<XrView, 2>& eyes) {
  for (XrView& eye : eyes) eye = typed<XrView>(XR_TYPE_VIEW);
  auto info = typed<XrViewLocateInfo>(XR_TYPE_VIEW_LOCATE_INFO);
  info.viewConfigurationType = kStereo;
  info.displayTime = time;
  info.space = room_;
  auto state = typed<XrViewState>(XR_TYPE_VIEW_STATE);
  std::uint32_t count = 0;
  const XrResult result = xrLocateViews(handle_, &info, &state, 2, &count, eyes.data());
  if (XR_FAILED(result)) return refused("xrLocateViews", result);
  constexpr XrViewStateFlags kPlace = XR_VIEW_STATE_POSITION_VALID_BIT | XR_VIEW_STATE_ORIENTATION_VALID_BIT;
  if (count != 2 || (state.viewStateFlags & kPlace) != kPlace) return false;  // not tracked for a moment
  const Pose left = to_pose(eyes[0].pose);
  head_ = Pose{0.5 * (left.position + to_pose(eyes[1].pose).position), left.orientation};
  return true;
}

XrResult Session::end_frame(XrTime time, std::span<const XrCompositionLayerBaseHeader* const> layers) const {
  auto end = typed<XrFrameEndInfo>(XR_TYPE_FRAME_END_INFO);
  end.displayTime = time;
  end.environmentBlendMode = blend_;
  end.layerCount = static_cast<std::uint32_t>(layers.size());
  end.layers = layers.data();
  return xrEndFrame(handle_, &end);
}

bool Session::acquire(const HeadsetPanel& panel, HeadsetPictures& pictures) {
  pictures.size = eyes_[0].size();
  pictures.panel_size = panel_.size();
  for (std::size_t i = 0; i < 2; ++i) {
    if (const XrResult result = eyes_[i].acquire(pictures.targets[i].texture); XR_FAILED(result))
      return refused("an eye's swapchain", result);
  }
  if (panel.size.x > 0.0 && (panel.renewed || !panel_drawn_)) {
    if (const XrResult result = panel_.acquire(pictures.panel.texture); XR_FAILED(result))
      return refused("the panel's swapchain", result);
  }
  return true;
}

bool Session::release() {
  bool fine = true;
  for (Swapchain* chain : {&eyes_[0], &eyes_[1], &panel_}) {
    if (!chain->acquired()) continue;
    if (const XrResult result = chain->release(); XR_FAILED(result))
      fine = refused("xrReleaseSwapchainImage", result);
  }
  return fine;
}

bool Session::frame(const std::function<HeadsetPlaces(const Pose& head)>& places,
                    const std::function<void(const HeadsetPictures&)>& draw) {
  if (!running_ || state_ == HeadsetState::kLost) return false;
  auto when = typed<XrFrameState>(XR_TYPE_FRAME_STATE);
  if (const XrResult result = xrWaitFrame(handle_, nullptr, &when); XR_FAILED(result))
    return refused("xrWaitFrame", result);
  if (const XrResult result = xrBeginFrame(handle_, nullptr); XR_FAILED(result))
    return refused("xrBeginFrame", result);
  period_ = 1e-9 * static_cast<double>(when.predictedDisplayPeriod);
  hands_.note_time(when.predictedDisplayTime);

  std::array<XrView, 2> eyes{};
  HeadsetPictures pictures;
  HeadsetPanel panel;
  bool drawn = when.shouldRender && locate_eyes(when.predictedDisplayTime, eyes);
  if (drawn) {
    const HeadsetPlaces at = places(*head_);
    panel = at.panel;
    drawn = acquire(panel, pictures);
    if (drawn) {
      for (std::size_t i = 0; i < 2; ++i) {
        const auto tangent = [](float angle) { return std::tan(static_cast<double>(angle)); };
        const XrFovf& fov = eyes[i].fov;
        pictures.views[i] = eye_view({to_pose(eyes[i].pose), tangent(fov.angleLeft), tangent(fov.angleRight),
                                      tangent(fov.angleDown), tangent(fov.angleUp)},
                                     at.room, options_.near_plane, options_.far_plane);
        if (panel.size.x <= 0.0) continue;
        pictures.panel_views[i] =
            panel_view(panel.pose, panel.size, to_pose(eyes[i].pose).position, at.room, options_.near_plane);
      }
      draw(pictures);
    }
    drawn = release() && drawn;  // also what was acquired before another was refused
    if (drawn && pictures.panel.texture != 0) panel_drawn_ = true;
  }

  std::array<XrCompositionLayerProjectionView, 2> pair{};
  for (std::size_t i = 0; i < 2; ++i) {
    pair[i].type = XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW;
    pair[i].pose = eyes[i].pose;
    pair[i].fov = eyes[i].fov;
    pair[i].subImage = eyes_[i].whole();
  }
  auto scene = typed<XrCompositionLayerProjection>(XR_TYPE_COMPOSITION_LAYER_PROJECTION);
  scene.space = room_;
  scene.viewCount = 2;
  scene.views = pair.data();
  auto board = typed<XrCompositionLayerQuad>(XR_TYPE_COMPOSITION_LAYER_QUAD);
  board.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
  board.space = room_;
  board.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
  board.subImage = panel_.whole();
  board.pose = from_pose(panel.pose);
  board.size = {static_cast<float>(panel.size.x), static_cast<float>(panel.size.y)};
  std::vector<const XrCompositionLayerBaseHeader*> layers;
  if (drawn) layers.push_back(reinterpret_cast<const XrCompositionLayerBaseHeader*>(&scene));
  if (drawn && panel_drawn_ && panel.size.x > 0.0)
    layers.push_back(reinterpret_cast<const XrCompositionLayerBaseHeader*>(&board));
  if (const XrResult result = end_frame(when.predictedDisplayTime, layers); XR_FAILED(result))
    return refused("xrEndFrame", result);
  if (drawn) refused_in_a_row_ = 0;
  return drawn;
}

}  // namespace slosh::xr
