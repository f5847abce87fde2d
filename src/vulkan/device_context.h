// SPDX-License-Identifier: Apache-2.0
// All that a frame in flight owns on an opened device, from frame to frame: commands, descriptors, buffers. Contexts of
// one device share no memory, so that the device may draw the frames of several at once. Failures are exceptions of
// vulkan.hpp, or Hang; the caller turns them into error values. Thread-safety: one thread at a time uses a context;
// several threads may each use one of the same device.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "render/device/frame_device.h"
#include "vulkan/buffer.h"
#include "vulkan/layout.h"
#include "vulkan/opened_device.h"
#include "vulkan/raii.h"
#include "vulkan/shader.h"
#include "vulkan/slots.h"

namespace contrejour::inline internal::vulkan {

// A submission that did not end in time. Its device must not be destroyed: it may still run.
struct Hang : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct GroupCount {
  std::uint32_t x = 1, y = 1;
};

// Workgroups of 64 invocations, in rows that the device can take.
[[nodiscard]] GroupCount groups_of(std::uint64_t invocations, const DeviceInfo& info);

// A caller's semaphores about a submission.
struct QueueSemaphores {
  VulkanSemaphore wait = {}, signal = {};
};

class DeviceContext {
 public:
  // options: of which the longest wait and what is called before submissions count.
  DeviceContext(std::shared_ptr<OpenedDevice> opened, const DeviceInfo& info, const DeviceOptions& options);
  ~DeviceContext();
  DeviceContext(const DeviceContext&) = delete;
  DeviceContext& operator=(const DeviceContext&) = delete;

  [[nodiscard]] Buffer& at(Slot slot) { return buffers_[static_cast<std::size_t>(slot)]; }
  // The most items of a size that a slot's buffer holds, and that shaders reach where they read it as texels.
  [[nodiscard]] std::uint64_t most_of(Slot slot, std::uint64_t bytes_an_item) const;
  // Makes a buffer large enough, and takes part in no submission meanwhile.
  void need(Slot slot, std::uint64_t bytes);
  void need_fetched(std::uint64_t bytes);  // what fetch() may copy in one submission
  void need(Buffer& other, std::uint64_t bytes) { other.need(device_, opened_->memory(), bytes); }
  template <class T>
  void upload(Slot slot, const std::vector<T>& values) {
    need(slot, values.size() * sizeof(T));
    at(slot).write(std::span<const T>(values));
  }

  // Replaces the first bytes of what was uploaded before.
  template <class T>
  void write_first(Slot slot, const std::vector<T>& values) {
    at(slot).write(std::span<const T>(values));
  }

  // A submission: begin, any number of the others, finish.
  void begin();
  template <class P>
  void dispatch(Program program, const P& parameters, GroupCount groups) {
    if (groups.x == 0 || groups.y == 0) return;
    push(program, parameters);
    commands_.front().dispatch(groups.x, groups.y, 1);
    if (counts_invocations_)
      invocations_ += opened_->group_size_of(program.shader) * std::uint64_t{groups.x} * groups.y;
  }
  // The path of the next dispatches that trace a grid: the first bytes of kPathSlots.
  void set_path(const std::array<std::uint32_t, kPathSlots.size()>& first_bytes);
  // The group counts are the device's: three words of Slot::Indirect, from this byte on.
  template <class P>
  void dispatch_indirect(Program program, const P& parameters, std::uint64_t byte) {
    push(program, parameters);
    commands_.front().dispatchIndirect(at(Slot::Indirect).handle(), byte);
    if (counts_invocations_) copy_group_counts(program.shader, byte);
  }
  void clear(Slot slot, std::uint64_t first_byte, std::uint64_t bytes);
  void barrier();  // what follows sees what came before
  void finish(const QueueSemaphores& semaphores = {});  // submits, and waits for the end
  // For commands that this class does not record itself, between begin() and finish().
  [[nodiscard]] const vk::raii::CommandBuffer& commands() const { return commands_.front(); }
  void copy(const Buffer& from, std::uint64_t from_byte, Slot to, std::uint64_t bytes);
  // Copies the first bytes of a buffer to where the host reads them: read() at the same byte, after finish().
  void fetch(Slot slot, std::uint64_t bytes, std::uint64_t to_byte = 0);
  template <class T>
  [[nodiscard]] const T* read(std::uint64_t byte = 0) const {
    return reinterpret_cast<const T*>(fetched_.read<std::byte>() + byte);
  }
  // A picture that outlives the submissions that draw parts of it, and one of the host.
  [[nodiscard]] Buffer& kept_rows() { return kept_rows_; }
  [[nodiscard]] Buffer& sent_rows() { return sent_rows_; }
  void keep(Slot slot, std::uint64_t bytes, std::uint64_t to_byte);  // copies to kept_rows()
  // Ends a stage: stages_ms() says how long each took, by the device's clock. Empty where it has none.
  void end_stage(std::string name);
  [[nodiscard]] const std::vector<std::pair<std::string, double>>& stages_ms() const { return stages_ms_; }

  [[nodiscard]] std::uint64_t invocations() const { return invocations_; }  // of shaders; 0: they are not counted
  [[nodiscard]] std::uint64_t fetched_bytes() const { return fetched_bytes_; }
  [[nodiscard]] std::uint64_t memory_bytes() const;

 private:
  void make_sets();
  void describe_buffers();
  void describe_texels();
  void read_clock();
  void copy_group_counts(Shader shader, std::uint64_t byte);
  void add_indirect_invocations();
  void submit(const QueueSemaphores& semaphores);
  template <class P>
  void push(Program program, const P& parameters) {
    static_assert(sizeof(P) <= kPushedBytes);
    const vk::raii::CommandBuffer& commands = commands_.front();
    commands.bindPipeline(vk::PipelineBindPoint::eCompute, opened_->pipeline_of(program));
    commands.pushConstants<P>(opened_->pipeline_layout(), vk::ShaderStageFlagBits::eCompute, 0, parameters);
  }

  std::shared_ptr<OpenedDevice> opened_;
  const vk::raii::Device& device_ = opened_->device();
  DeviceInfo info_;
  double longest_wait_s_;
  std::function<void(std::uint64_t)> before_submission_;
  vk::raii::DescriptorPool descriptor_pool_ = nullptr;
  std::vector<vk::raii::DescriptorSet> sets_;  // that of all buffers, and that of the path
  vk::raii::CommandPool command_pool_ = nullptr;
  std::vector<vk::raii::CommandBuffer> commands_;  // one
  vk::raii::Fence fence_ = nullptr;
  vk::raii::QueryPool clock_ = nullptr;  // null: the queue has none
  std::vector<std::string> stages_;  // of the submission that is being made
  std::vector<std::pair<std::string, double>> stages_ms_;
  // On processors only, as the copies of group counts may take time.
  bool counts_invocations_ = info_.kind == "processor";
  std::vector<std::uint32_t> indirect_group_sizes_;  // of the submission that is being made
  Buffer indirect_groups_{Residence::Download};
  std::vector<Buffer> buffers_;  // by Slot
  std::vector<vk::raii::BufferView> views_;  // by kTexelSlots
  Buffer fetched_{Residence::Download}, kept_rows_{Residence::Device}, sent_rows_{Residence::Upload};
  bool described_ = false;
  std::uint64_t submissions_ = 0, invocations_ = 0, fetched_bytes_ = 0;
};

}  // namespace contrejour::inline internal::vulkan
