// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/window.h"

#include <algorithm>
#include <string_view>
#include <utility>
#include <vector>

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include "studio/ui/theme.h"

namespace contrejour::studio {
namespace {

constexpr const char* kWithoutWindow = "; the command line renders without a window: contrejour render --session FILE";
constexpr double kLongestFrame_s = 0.1;  // for animations after a pause

std::string last_glfw_error() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "unknown reason";
}

// A swap of buffers leaves the pixels to draw on undefined. Mesa without a graphics card copies them to the window,
// and keeps them (drisw_glx.c); with rotating buffers, whose age GLX tells, it does not. A graphics card draws whole
// frames in no time.
bool swap_copies() {
  const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
  const bool is_software = renderer != nullptr && std::string_view(renderer).find("llvmpipe") != std::string_view::npos;
  return is_software && glfwExtensionSupported("GLX_EXT_buffer_age") == GLFW_FALSE;
}

Window& of(GLFWwindow* window) { return *static_cast<Window*>(glfwGetWindowUserPointer(window)); }

const char* clipboard_text(void* window) { return glfwGetClipboardString(static_cast<GLFWwindow*>(window)); }
void set_clipboard_text(void* window, const char* text) {
  glfwSetClipboardString(static_cast<GLFWwindow*>(window), text);
}

void set_up_imgui(GLFWwindow* window, const WindowSettings& settings) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
  io.ConfigInputTextCursorBlink = false;
  io.ConfigWindowsMoveFromTitleBarOnly = true;
  io.ConfigDragClickToInputText = true;
  io.GetClipboardTextFn = clipboard_text;
  io.SetClipboardTextFn = set_clipboard_text;
  io.ClipboardUserData = window;
  set_up_keys();
  set_theme(settings.scale, settings.high_contrast);
  ImGui_ImplOpenGL3_Init("#version 330");
}

}  // namespace

Result<std::unique_ptr<Window>> Window::open(const WindowSettings& settings) {
  if (glfwInit() == GLFW_FALSE)
    return failure(ErrorCode::Unsupported, "no display: " + last_glfw_error() + kWithoutWindow);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
  glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
  glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
  glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
  GLFWwindow* window = glfwCreateWindow(settings.width, settings.height, "Contrejour", nullptr, nullptr);
  if (window == nullptr) {
    const std::string reason = last_glfw_error();
    glfwTerminate();
    return failure(ErrorCode::Unsupported, "the studio needs OpenGL 3.3: " + reason + kWithoutWindow);
  }
  glfwMakeContextCurrent(window);
  glfwSwapInterval(settings.waits_for_display ? 1 : 0);
  set_up_imgui(window, settings);
  return std::unique_ptr<Window>(new Window(window, settings));
}

Window::Window(GLFWwindow* window, const WindowSettings& settings)
    : window_(window), scale_(settings.scale), high_contrast_(settings.high_contrast), keeps_pixels_(swap_copies()),
      last_frame_s_(glfwGetTime()) {
  connect();
}

Window::~Window() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::connect() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetCursorPosCallback(window_, [](GLFWwindow* w, double x, double y) { of(w).input_.push(MouseMoved{x, y}); });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* w, int button, int action, int /*mods*/) {
    double x = 0, y = 0;
    glfwGetCursorPos(w, &x, &y);
    of(w).input_.push(MouseMoved{x, y});
    of(w).input_.push(MouseButton{button, action == GLFW_PRESS});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* w, double x, double y) { of(w).input_.push(MouseWheel{x, y}); });
  glfwSetKeyCallback(window_, [](GLFWwindow* w, int key, int /*scan*/, int action, int /*mods*/) {
    if (action != GLFW_REPEAT) of(w).input_.push(KeyChanged{key, action == GLFW_PRESS});
  });
  glfwSetCharCallback(window_, [](GLFWwindow* w, unsigned int code) { of(w).input_.push(CharacterTyped{code}); });
  glfwSetWindowRefreshCallback(window_, [](GLFWwindow* w) { of(w).redraw(); });
  glfwSetDropCallback(window_, [](GLFWwindow* w, int count, const char** files) {
    if (count > 0) of(w).dropped_ = files[0];
  });
}

void Window::wait(double seconds) {
  if (input_.is_empty() && seconds > 0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
}

void Window::rest(double seconds) { glfwWaitEventsTimeout(seconds); }

void Window::begin_frame() {
  ImGuiIO& io = ImGui::GetIO();
  glfwGetWindowSize(window_, &width_, &height_);
  int pixels_across = 0, pixels_down = 0;
  glfwGetFramebufferSize(window_, &pixels_across, &pixels_down);
  io.DisplaySize = {static_cast<float>(width_), static_cast<float>(height_)};
  if (width_ > 0 && height_ > 0)
    io.DisplayFramebufferScale = {static_cast<float>(pixels_across) / io.DisplaySize.x,
                                  static_cast<float>(pixels_down) / io.DisplaySize.y};
  const double now = glfwGetTime();
  io.DeltaTime = static_cast<float>(std::clamp(now - last_frame_s_, 1e-4, kLongestFrame_s));
  last_frame_s_ = now;
  input_.feed_frame();
  ImGui_ImplOpenGL3_NewFrame();
  ImGui::NewFrame();
}

// False: nothing has changed.
bool Window::draw_changes() {
  ImDrawData& frame = *ImGui::GetDrawData();
  int pixels_across = 0, pixels_down = 0;
  glfwGetFramebufferSize(window_, &pixels_across, &pixels_down);
  const PixelRect whole{0, 0, pixels_across, pixels_down};
  std::vector<PixelRect> changed = tiles_.find(frame);
  drawn_part_ = 0;
  if (changed.empty()) return false;
  if (!keeps_pixels_) changed = {whole};
  if (changed != std::vector{whole}) reduce_to(changed, frame);
  const ImVec4 back = ImGui::GetStyleColorVec4(ImGuiCol_ChildBg);
  glClearColor(back.x, back.y, back.z, 1);
  glEnable(GL_SCISSOR_TEST);
  for (const PixelRect& r : changed) {
    glScissor(r.x0, pixels_down - r.y1, r.x1 - r.x0, r.y1 - r.y0);
    glClear(GL_COLOR_BUFFER_BIT);
    drawn_part_ += static_cast<double>(r.area()) / static_cast<double>(whole.area());
  }
  ImGui_ImplOpenGL3_RenderDrawData(&frame);
  return true;
}

void Window::end_frame(const std::function<void()>& before_swap) {
  ImGui::Render();
  const bool shows = draw_changes();
  if (before_swap) before_swap();
  if (shows) glfwSwapBuffers(window_);
}

void Window::set_scale(float scale) {
  if (scale == scale_) return;
  scale_ = scale;
  ImGui_ImplOpenGL3_DestroyFontsTexture();
  set_theme(scale, high_contrast_);
  ImGui_ImplOpenGL3_CreateFontsTexture();
  redraw();
}

void Window::prepare_reading() {
  if (!keeps_pixels_) redraw();
}

void Window::wake() { glfwPostEmptyEvent(); }

bool Window::wants_to_close() const { return glfwWindowShouldClose(window_) != GLFW_FALSE; }
void Window::refuse_to_close() { glfwSetWindowShouldClose(window_, GLFW_FALSE); }

void Window::set_title(const std::string& title) {
  if (title == title_) return;
  title_ = title;
  glfwSetWindowTitle(window_, title.c_str());
}

std::string Window::dropped_file() { return std::exchange(dropped_, {}); }

}  // namespace contrejour::studio
