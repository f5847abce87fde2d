// SPDX-License-Identifier: Apache-2.0
// Acts as a node of Natron does. Sources: NatronGitHub/Natron (Engine/OfxHost.cpp, OfxEffectInstance.cpp,
// OfxImageEffectInstance.cpp, OfxClipInstance.cpp) and the HostSupport library of NatronGitHub/openfx, read for what
// they call and pass; no line is taken from them. What a plug-in has to cope with:
// - of several contexts Natron takes general before filter before generator, so that a source may be absent;
// - property sets have a fixed list of properties, and refuse all others;
// - regions are asked for at scale 1 and at a half as soon as an instance exists, and a failure means no preview
// scales;
// - renders run on clones: an instance whose properties, the plug-in's own pointer among them, are copied before it is
//   created, while the first one lives;
// - abort() is about the thread that asks: others are never told to stop;
// - an image may begin at negative coordinates, and a clip may have none.
#pragma once

#include <memory>
#include <thread>

#include "test_host.h"

namespace contrejour::openfx {

[[nodiscard]] HostOptions natron_options();

class NatronNode {
 public:
  // With an image as its source, or none. The pictures outlive the node.
  NatronNode(const TestHost& host, double project_width, double project_height, HostPicture* source);
  ~NatronNode() { host_.destroy(*effect_); }
  NatronNode(const NatronNode&) = delete;
  NatronNode& operator=(const NatronNode&) = delete;

  [[nodiscard]] EffectStruct& effect() const { return *effect_; }
  // The region that the effect gives, in canonical coordinates. Errors: std::runtime_error, as Natron's failure.
  [[nodiscard]] RectD region(double scale) const;
  // All of Natron's calls for a picture, on a clone and on the calling thread. Returns the status of the render action.
  // Whether the render thread is told to stop: asked again and again.
  [[nodiscard]] Status render(HostPicture& output, double time, double scale, bool aborts = false) const;

 private:
  [[nodiscard]] std::unique_ptr<EffectStruct> clone() const;

  const TestHost& host_;
  double width_, height_;
  HostPicture* source_;
  std::unique_ptr<EffectStruct> effect_;
};

}  // namespace contrejour::openfx
