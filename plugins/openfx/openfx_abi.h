// SPDX-License-Identifier: Apache-2.0
// The part of the OpenFX standard that this plug-in and its test host use: structures, tables of functions, and names.
// Source: OpenFX 1.5, "The OpenFX Image Effect Plugin API" (openfx.readthedocs.io) and the reference headers of the
// Academy Software Foundation's project (openfx 1.5.1: ofxCore.h, ofxProperty.h, ofxParam.h, ofxImageEffect.h,
// ofxMultiThread.h, ofxMessage.h, ofxInteract.h, ofxDrawSuite.h). The order of the members of each table is the binary
// interface. Names are the standard's without its prefixes: kOfxImageEffectPropRenderScale is name::kRenderScale.
#pragma once

#include <cstddef>

namespace contrejour::openfx {

extern "C" {

// ofxCore.h
using Status = int;
using Time = double;
using PropertySetHandle = struct PropertySetStruct*;
struct RectI {
  int x1, y1, x2, y2;
};
struct RectD {
  double x1, y1, x2, y2;
};
struct RangeD {
  double min, max;
};

struct HostTable {
  PropertySetHandle host;
  const void* (*fetch_suite)(PropertySetHandle host, const char* name, int version);
};

using EntryPoint = Status (*)(const char* action, const void* handle, PropertySetHandle in, PropertySetHandle out);

struct PluginTable {
  const char* api;
  int api_version;
  const char* identifier;
  unsigned int version_major, version_minor;
  void (*set_host)(HostTable* host);
  EntryPoint main_entry;
};

// ofxProperty.h
struct PropertySuite {
  static constexpr const char* kName = "OfxPropertySuite";
  Status (*set_pointer)(PropertySetHandle, const char* property, int index, void* value);
  Status (*set_string)(PropertySetHandle, const char* property, int index, const char* value);
  Status (*set_double)(PropertySetHandle, const char* property, int index, double value);
  Status (*set_int)(PropertySetHandle, const char* property, int index, int value);
  Status (*set_pointer_n)(PropertySetHandle, const char* property, int count, void* const* values);
  Status (*set_string_n)(PropertySetHandle, const char* property, int count, const char* const* values);
  Status (*set_double_n)(PropertySetHandle, const char* property, int count, const double* values);
  Status (*set_int_n)(PropertySetHandle, const char* property, int count, const int* values);
  Status (*get_pointer)(PropertySetHandle, const char* property, int index, void** value);
  Status (*get_string)(PropertySetHandle, const char* property, int index, char** value);
  Status (*get_double)(PropertySetHandle, const char* property, int index, double* value);
  Status (*get_int)(PropertySetHandle, const char* property, int index, int* value);
  Status (*get_pointer_n)(PropertySetHandle, const char* property, int count, void** values);
  Status (*get_string_n)(PropertySetHandle, const char* property, int count, char** values);
  Status (*get_double_n)(PropertySetHandle, const char* property, int count, double* values);
  Status (*get_int_n)(PropertySetHandle, const char* property, int count, int* values);
  Status (*reset)(PropertySetHandle, const char* property);
  Status (*get_dimension)(PropertySetHandle, const char* property, int* count);
};

// ofxParam.h. Values go through variable arguments: int, double and char*, or pointers to them, once per component.
using ParamHandle = struct ParamStruct*;
using ParamSetHandle = struct ParamSetStruct*;
struct ParameterSuite {
  static constexpr const char* kName = "OfxParameterSuite";
  Status (*define)(ParamSetHandle, const char* type, const char* name, PropertySetHandle* properties);
  Status (*get_handle)(ParamSetHandle, const char* name, ParamHandle* param, PropertySetHandle* properties);
  Status (*set_get_property_set)(ParamSetHandle, PropertySetHandle* properties);
  Status (*get_property_set)(ParamHandle, PropertySetHandle* properties);
  Status (*get_value)(ParamHandle, ...);
  Status (*get_value_at_time)(ParamHandle, Time, ...);
  Status (*get_derivative)(ParamHandle, Time, ...);
  Status (*get_integral)(ParamHandle, Time, Time, ...);
  Status (*set_value)(ParamHandle, ...);
  Status (*set_value_at_time)(ParamHandle, Time, ...);
  Status (*get_num_keys)(ParamHandle, unsigned int* count);
  Status (*get_key_time)(ParamHandle, unsigned int nth, Time* time);
  Status (*get_key_index)(ParamHandle, Time, int direction, int* index);
  Status (*delete_key)(ParamHandle, Time);
  Status (*delete_all_keys)(ParamHandle);
  Status (*copy)(ParamHandle to, ParamHandle from, Time offset, const RangeD* range);
  Status (*edit_begin)(ParamSetHandle, const char* name);
  Status (*edit_end)(ParamSetHandle);
};

// ofxImageEffect.h
using EffectHandle = struct EffectStruct*;
using ClipHandle = struct ClipStruct*;
using ImageMemoryHandle = struct ImageMemoryStruct*;
struct ImageEffectSuite {
  static constexpr const char* kName = "OfxImageEffectSuite";
  Status (*get_property_set)(EffectHandle, PropertySetHandle* properties);
  Status (*get_param_set)(EffectHandle, ParamSetHandle* params);
  Status (*clip_define)(EffectHandle, const char* name, PropertySetHandle* properties);
  Status (*clip_get_handle)(EffectHandle, const char* name, ClipHandle* clip, PropertySetHandle* properties);
  Status (*clip_get_property_set)(ClipHandle, PropertySetHandle* properties);
  Status (*clip_get_image)(ClipHandle, Time, const RectD* region, PropertySetHandle* image);
  Status (*clip_release_image)(PropertySetHandle image);
  Status (*clip_get_region_of_definition)(ClipHandle, Time, RectD* bounds);
  int (*abort)(EffectHandle);
  Status (*memory_alloc)(EffectHandle, std::size_t bytes, ImageMemoryHandle*);
  Status (*memory_free)(ImageMemoryHandle);
  Status (*memory_lock)(ImageMemoryHandle, void** pointer);
  Status (*memory_unlock)(ImageMemoryHandle);
};

// ofxMultiThread.h; its mutexes are not used, because some hosts have none.
struct MultiThreadSuite {
  static constexpr const char* kName = "OfxMultiThreadSuite";
  Status (*multi_thread)(void (*body)(unsigned int index, unsigned int count, void* argument), unsigned int count,
                         void* argument);
  Status (*cpu_count)(unsigned int* count);
  Status (*thread_index)(unsigned int* index);
  int (*is_spawned_thread)();
  void* mutex_functions[5];
};

// ofxMessage.h, version 2; version 1 has the first member alone.
struct MessageSuite {
  static constexpr const char* kName = "OfxMessageSuite";
  Status (*message)(void* handle, const char* type, const char* id, const char* format, ...);
  Status (*set_persistent_message)(void* handle, const char* type, const char* id, const char* format, ...);
  Status (*clear_persistent_message)(void* handle);
};

// ofxInteract.h
using InteractHandle = struct InteractStruct*;
struct InteractSuite {
  static constexpr const char* kName = "OfxInteractSuite";
  Status (*swap_buffers)(InteractHandle);
  Status (*redraw)(InteractHandle);
  Status (*get_property_set)(InteractHandle, PropertySetHandle* properties);
};

// ofxDrawSuite.h
using DrawContext = struct DrawContextStruct*;
struct PointD {
  double x, y;
};
struct ColourF {
  float r, g, b, a;
};
struct DrawSuite {
  static constexpr const char* kName = "OfxDrawSuite";
  Status (*get_colour)(DrawContext, int standard_colour, ColourF* colour);
  Status (*set_colour)(DrawContext, const ColourF* colour);
  Status (*set_line_width)(DrawContext, float width);
  Status (*set_line_stipple)(DrawContext, int pattern);
  Status (*draw)(DrawContext, int primitive, const PointD* points, int count);
  Status (*draw_text)(DrawContext, const char* text, const PointD* position, int alignment);
};
enum DrawPrimitive { kDrawLines, kDrawLineStrip, kDrawLineLoop };  // those that are used here

}  // extern "C"

namespace status {
inline constexpr Status kOk = 0, kFailed = 1, kErrFatal = 2, kErrUnknown = 3, kErrMissingHostFeature = 4,
                        kErrUnsupported = 5, kErrExists = 6, kErrFormat = 7, kErrMemory = 8, kErrBadHandle = 9,
                        kErrBadIndex = 10, kErrValue = 11, kReplyYes = 12, kReplyNo = 13, kReplyDefault = 14,
                        kErrImageFormat = 1000;
}  // namespace status

inline constexpr const char* kImageEffectApi = "OfxImageEffectPluginAPI";

namespace action {
inline constexpr const char *kLoad = "OfxActionLoad", *kUnload = "OfxActionUnload", *kDescribe = "OfxActionDescribe",
                            *kCreateInstance = "OfxActionCreateInstance",
                            *kDestroyInstance = "OfxActionDestroyInstance", *kPurgeCaches = "OfxActionPurgeCaches",
                            *kSyncPrivateData = "OfxActionSyncPrivateData",
                            *kInstanceChanged = "OfxActionInstanceChanged",
                            *kDescribeInContext = "OfxImageEffectActionDescribeInContext",
                            *kRender = "OfxImageEffectActionRender", *kIsIdentity = "OfxImageEffectActionIsIdentity",
                            *kGetRegionOfDefinition = "OfxImageEffectActionGetRegionOfDefinition",
                            *kGetRegionsOfInterest = "OfxImageEffectActionGetRegionsOfInterest",
                            *kGetClipPreferences = "OfxImageEffectActionGetClipPreferences";
// Actions of interacts, which have kCreateInstance and kDestroyInstance, too.
inline constexpr const char *kDraw = "OfxInteractActionDraw", *kPenMotion = "OfxInteractActionPenMotion",
                            *kPenDown = "OfxInteractActionPenDown", *kPenUp = "OfxInteractActionPenUp";
}  // namespace action

namespace context {
inline constexpr const char *kFilter = "OfxImageEffectContextFilter", *kGenerator = "OfxImageEffectContextGenerator",
                            *kGeneral = "OfxImageEffectContextGeneral";
}  // namespace context

namespace clip {
inline constexpr const char *kSource = "Source", *kOutput = "Output";
}  // namespace clip

// Names of properties.
namespace name {
inline constexpr const char *kName = "OfxPropName", *kLabel = "OfxPropLabel", *kShortLabel = "OfxPropShortLabel",
                            *kLongLabel = "OfxPropLongLabel", *kVersion = "OfxPropVersion",
                            *kVersionLabel = "OfxPropVersionLabel", *kPluginDescription = "OfxPropPluginDescription",
                            *kType = "OfxPropType", *kTime = "OfxPropTime", *kInstanceData = "OfxPropInstanceData",
                            *kChangeReason = "OfxPropChangeReason";
// Properties of an effect, its descriptor, and the arguments of actions.
inline constexpr const char
    *kContext = "OfxImageEffectPropContext",
    *kSupportedContexts = "OfxImageEffectPropSupportedContexts",
    *kSupportedPixelDepths = "OfxImageEffectPropSupportedPixelDepths", *kGrouping = "OfxImageEffectPluginPropGrouping",
    *kRenderThreadSafety = "OfxImageEffectPluginRenderThreadSafety",
    *kHostFrameThreading = "OfxImageEffectPluginPropHostFrameThreading",
    *kSingleInstance = "OfxImageEffectPluginPropSingleInstance",
    *kFieldRenderTwice = "OfxImageEffectPluginPropFieldRenderTwiceAlways",
    *kSupportsTiles = "OfxImageEffectPropSupportsTiles",
    *kSupportsMultiResolution = "OfxImageEffectPropSupportsMultiResolution",
    *kTemporalClipAccess = "OfxImageEffectPropTemporalClipAccess",
                            // These two values do not follow their macros' names in the reference headers:
    // kOfxImageEffectPropSupportsMultipleClipDepths, kOfxImageEffectPropProjectPixelAspectRatio.
        *kSupportsMultipleClipDepths = "OfxImageEffectPropMultipleClipDepths",
    *kProjectPixelAspectRatio = "OfxImageEffectPropPixelAspectRatio",
    *kSupportsMultipleClipPars = "OfxImageEffectPropSupportsMultipleClipPARs",
    *kNoSpatialAwareness = "OfxImageEffectPropNoSpatialAwareness", *kProjectSize = "OfxImageEffectPropProjectSize",
    *kProjectOffset = "OfxImageEffectPropProjectOffset", *kProjectExtent = "OfxImageEffectPropProjectExtent",
    *kRenderWindow = "OfxImageEffectPropRenderWindow", *kRenderScale = "OfxImageEffectPropRenderScale",
    *kInteractiveRender = "OfxImageEffectPropInteractiveRenderStatus",
    *kRenderQualityDraft = "OfxImageEffectPropRenderQualityDraft",
    *kRegionOfDefinition = "OfxImageEffectPropRegionOfDefinition",
    *kRegionOfInterest = "OfxImageEffectPropRegionOfInterest", *kFrameVarying = "OfxImageEffectFrameVarying";
// Properties of interacts.
inline constexpr const char *kOverlayV1 = "OfxImageEffectPluginPropOverlayInteractV1",
                            *kOverlayV2 = "OfxImageEffectPluginPropOverlayInteractV2",
                            *kEffectInstance = "OfxPropEffectInstance", *kPixelScale = "OfxInteractPropPixelScale",
                            *kPenPosition = "OfxInteractPropPenPosition", *kDrawContext = "OfxInteractPropDrawContext";
// Properties of clips and images.
inline constexpr const char *kSupportedComponents = "OfxImageEffectPropSupportedComponents",
                            *kClipConnected = "OfxImageClipPropConnected", *kClipOptional = "OfxImageClipPropOptional",
                            *kClipFieldExtraction = "OfxImageClipPropFieldExtraction",
                            *kClipRoiOfSource = "OfxImageClipPropRoI_Source",
                            *kComponents = "OfxImageEffectPropComponents",
                            *kPixelDepth = "OfxImageEffectPropPixelDepth", *kImageData = "OfxImagePropData",
                            *kImageBounds = "OfxImagePropBounds", *kImageRowBytes = "OfxImagePropRowBytes",
                            *kImagePixelAspectRatio = "OfxImagePropPixelAspectRatio";
// Properties of parameters.
inline constexpr const char *kDefault = "OfxParamPropDefault", *kMin = "OfxParamPropMin", *kMax = "OfxParamPropMax",
                            *kDisplayMin = "OfxParamPropDisplayMin", *kDisplayMax = "OfxParamPropDisplayMax",
                            *kHint = "OfxParamPropHint", *kScriptName = "OfxParamPropScriptName",
                            *kParent = "OfxParamPropParent", *kChoiceOption = "OfxParamPropChoiceOption",
                            *kStringMode = "OfxParamPropStringMode",
                            *kStringFilePathExists = "OfxParamPropStringFilePathExists",
                            *kGroupOpen = "OfxParamPropGroupOpen", *kDoubleType = "OfxParamPropDoubleType",
                            *kDefaultCoordinateSystem = "OfxParamPropDefaultCoordinateSystem",
                            *kDigits = "OfxParamPropDigits", *kAnimates = "OfxParamPropAnimates";
}  // namespace name

// Values of properties.
namespace value {
inline constexpr const char *kFullySafe = "OfxImageEffectRenderFullySafe", *kFloat = "OfxBitDepthFloat",
                            *kHalf = "OfxBitDepthHalf", *kRgba = "OfxImageComponentRGBA",
                            *kRgb = "OfxImageComponentRGB", *kFieldDoubled = "OfxImageFieldDoubled",
                            *kUserEdited = "OfxChangeUserEdited", *kMessageWarning = "OfxMessageWarning",
                            *kMessageLog = "OfxMessageLog", *kDoublePlain = "OfxParamDoubleTypePlain",
                            *kDoublePoint = "OfxParamDoubleTypeXYAbsolute",
                            *kNormalised = "OfxParamCoordinatesNormalised", *kSingleLine = "OfxParamStringIsSingleLine",
                            *kFilePath = "OfxParamStringIsFilePath";
}  // namespace value

namespace type {
inline constexpr const char *kInteger = "OfxParamTypeInteger", *kDouble = "OfxParamTypeDouble",
                            *kDouble2D = "OfxParamTypeDouble2D", *kRgb = "OfxParamTypeRGB",
                            *kBoolean = "OfxParamTypeBoolean", *kChoice = "OfxParamTypeChoice",
                            *kString = "OfxParamTypeString", *kGroup = "OfxParamTypeGroup",
                            *kPushButton = "OfxParamTypePushButton";
}  // namespace type

}  // namespace contrejour::openfx
