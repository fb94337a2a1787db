#include <ImfArray.h>
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <charconv>
#include <functional>

#include "core/error.h"
#include "io/exr/range_image.h"

namespace tarmac::io {
namespace {

using core::InputError;

/// A channel of a layer: its name, unit and values.
struct Channel {
  std::string name;
  const char* unit;
  Imf::PixelType type;
  std::function<char*(RangeLayer&)> values;
  bool of_truth;
};

template <class T>
Channel channel(std::string name, const char* unit, std::vector<T> RangeLayer::*values, bool of_truth) {
  return {std::move(name), unit, std::is_same_v<T, float> ? Imf::FLOAT : Imf::UINT,
          [values](RangeLayer& layer) { return reinterpret_cast<char*>((layer.*values).data()); }, of_truth};
}

const std::vector<Channel>& channels() {
  static const std::vector<Channel> list = {
      channel("range", "m, from the sensor frame's origin; 0 = no return", &RangeLayer::range_m, false),
      channel("intensity", "as recorded, 0 to 255", &RangeLayer::intensity, false),
      channel("time", "ns from timeOriginNs", &RangeLayer::time_ns, false),
      channel("normal.X", "unit vector in the world, towards the sensor", &RangeLayer::normal_x, true),
      channel("normal.Y", "unit vector in the world, towards the sensor", &RangeLayer::normal_y, true),
      channel("normal.Z", "unit vector in the world, towards the sensor", &RangeLayer::normal_z, true),
      channel("incidence", "cosine of the angle of incidence", &RangeLayer::cos_incidence, true),
      channel("label", "number of the class", &RangeLayer::label, true),
      channel("instance", "number in the scene; 4294967295 = none", &RangeLayer::instance, true),
      channel("moving", "1 = belongs to a moving actor", &RangeLayer::moving, true),
      channel("kind", "kind of return", &RangeLayer::kind, true)};
  return list;
}

std::string layer_prefix(std::size_t layer) {
  return layer == 0 ? "" : "second.";
}

/// The pixels of all channels that the image has.
Imf::FrameBuffer frame_buffer(RangeImage& image) {
  Imf::FrameBuffer buffer;
  for (std::size_t layer = 0; layer < image.returns.size(); ++layer)
    for (const Channel& c : channels()) {
      if (c.of_truth && !image.with_truth) continue;
      buffer.insert(layer_prefix(layer) + c.name,
                    Imf::Slice(c.type, c.values(image.returns[layer]), 4, 4 * image.width));
    }
  return buffer;
}

void put(Imf::Header& header, const char* name, const std::string& text) {
  header.insert(name, Imf::StringAttribute(text));
}

Imf::Header header_of(const RangeImage& image) {
  Imf::Header header(static_cast<int>(image.width), static_cast<int>(image.height));
  header.compression() = Imf::ZIP_COMPRESSION;
  put(header, "software", "tarmac");
  put(header, "sensor", image.sensor);
  put(header, "rows", "rings, the highest first");
  put(header, "columns", image.columns);
  // Attributes have no 64-bit integers.
  put(header, "sweep", std::to_string(image.sweep));
  put(header, "beginNs", std::to_string(image.begin_ns));
  put(header, "endNs", std::to_string(image.end_ns));
  put(header, "timeOriginNs", std::to_string(image.time_origin_ns));
  for (const Channel& c : channels())
    if (image.with_truth || !c.of_truth) put(header, ("unit." + c.name).c_str(), c.unit);
  for (std::size_t layer = 0; layer < image.returns.size(); ++layer)
    for (const Channel& c : channels())
      if (image.with_truth || !c.of_truth)
        header.channels().insert(layer_prefix(layer) + c.name, Imf::Channel(c.type, 1, 1, true));
  return header;
}

std::string text_of(const Imf::Header& header, const char* name, const std::string& file) {
  const auto* attribute = header.findTypedAttribute<Imf::StringAttribute>(name);
  if (!attribute)
    throw InputError(fmt::format("{}: has no attribute {}; it is no range image of tarmac export", file, name));
  return attribute->value();
}

std::int64_t number_of(const Imf::Header& header, const char* name, const std::string& file) {
  const std::string text = text_of(header, name, file);
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size())
    throw InputError(fmt::format("{}: attribute {}: '{}' is no whole number", file, name, text));
  return number;
}

RangeImage described(const Imf::Header& header, const std::string& file) {
  RangeImage image;
  const Imath::Box2i window = header.dataWindow();
  image.width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  image.height = static_cast<std::size_t>(window.max.y - window.min.y + 1);
  image.sensor = text_of(header, "sensor", file);
  image.columns = text_of(header, "columns", file);
  image.sweep = number_of(header, "sweep", file);
  image.begin_ns = number_of(header, "beginNs", file);
  image.end_ns = number_of(header, "endNs", file);
  image.time_origin_ns = number_of(header, "timeOriginNs", file);
  image.with_truth = header.channels().findChannel("label") != nullptr;
  image.returns.resize(header.channels().findChannel("second.range") ? 2 : 1);
  return image;
}

void check_channels(const Imf::Header& header, const RangeImage& image, const std::string& file) {
  for (std::size_t layer = 0; layer < image.returns.size(); ++layer)
    for (const Channel& c : channels()) {
      if (c.of_truth && !image.with_truth) continue;
      const std::string name = layer_prefix(layer) + c.name;
      const Imf::Channel* found = header.channels().findChannel(name);
      if (!found || found->type != c.type)
        throw InputError(fmt::format("{}: has no {} channel {}", file, c.type == Imf::FLOAT ? "FLOAT" : "UINT", name));
    }
}

}  // namespace

void write_range_image(const std::filesystem::path& file, const RangeImage& image) {
  const std::filesystem::path part = file.string() + ".part";
  try {
    RangeImage pixels = image;  // frame buffers have no const
    Imf::OutputFile out(part.c_str(), header_of(image), 0);
    out.setFrameBuffer(frame_buffer(pixels));
    out.writePixels(static_cast<int>(image.height));
  } catch (const std::exception& error) {
    std::error_code ignored;
    std::filesystem::remove(part, ignored);
    throw InputError(fmt::format("{}: cannot be written: {}", file.string(), error.what()));
  }
  std::filesystem::rename(part, file);
}

RangeImage read_range_image(const std::filesystem::path& file) {
  try {
    Imf::InputFile in(file.c_str(), 0);
    RangeImage image = described(in.header(), file.string());
    check_channels(in.header(), image, file.string());
    for (RangeLayer& layer : image.returns) layer.resize(image.width * image.height, image.with_truth);
    const Imath::Box2i window = in.header().dataWindow();
    if (window.min.x != 0 || window.min.y != 0)
      throw InputError(fmt::format("{}: its pixels do not begin at (0, 0)", file.string()));
    in.setFrameBuffer(frame_buffer(image));
    in.readPixels(window.min.y, window.max.y);
    return image;
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: cannot be read as OpenEXR: {}", file.string(), error.what()));
  }
}

}  // namespace tarmac::io
