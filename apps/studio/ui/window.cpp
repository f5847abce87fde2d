// SPDX-License-Identifier: Apache-2.0
#include "studio/ui/window.h"

#include <algorithm>
#include <utility>

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
  return std::unique_ptr<Window>(new Window(window));
}

Window::Window(GLFWwindow* window) : window_(window), last_frame_s_(glfwGetTime()) { connect(); }

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

void Window::end_frame(const std::function<void()>& before_swap) {
  ImGui::Render();
  const ImVec4 back = ImGui::GetStyleColorVec4(ImGuiCol_ChildBg);
  int pixels_across = 0, pixels_down = 0;
  glfwGetFramebufferSize(window_, &pixels_across, &pixels_down);
  glViewport(0, 0, pixels_across, pixels_down);
  glClearColor(back.x, back.y, back.z, 1);
  glClear(GL_COLOR_BUFFER_BIT);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  if (before_swap) before_swap();
  glfwSwapBuffers(window_);
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
