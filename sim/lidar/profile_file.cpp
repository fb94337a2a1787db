#include "sim/lidar/profile_file.h"

#include <fmt/format.h>

#include "core/error.h"
#include "sim/lidar/channel_table.h"
#include "sim/lidar/ouster_metadata.h"

namespace tarmac::sim::lidar {
namespace {

using core::ConfigNode;
namespace fs = std::filesystem;

void read_channels(const ConfigNode& node, Profile& p) {
  const ConfigNode channels = node.child("channels");
  if (!channels.present()) return;
  const fs::path file = fs::path(node.file()).parent_path() / channels.scalar("channels");
  if (!fs::is_regular_file(file)) channels.fail(fmt::format("{}: there is no such file", file.string()));
  if (file.extension() == ".csv")
    read_channel_table(file, p);
  else if (file.extension() == ".json")
    read_ouster_beams(file, p);
  else
    channels.fail(fmt::format("'{}' must be a .csv table or an Ouster metadata .json", channels.scalar("channels")));
  for (const ChannelColumn& column : channel_columns())
    if (node.child(column.name).present() && !(p.*column.values).empty())
      node.child(column.name).fail(fmt::format("stands in {} as well; remove one", file.filename().string()));
}

Profile from_yaml(const fs::path& file) {
  const ConfigNode node = ConfigNode::load(file.string());
  Profile p;
  p.name = file.stem().string();
  if (!node.is_block()) node.fail("a sensor is a block of `key: value` lines");
  read_channels(node, p);
  node.read(p, {"channels"});
  complete(node, p);
  return p;
}

}  // namespace

bool is_profile_path(const std::string& model) {
  const std::string extension = fs::path(model).extension().string();
  return model.find('/') != std::string::npos || extension == ".yaml" || extension == ".yml" || extension == ".json" ||
         extension == ".csv";
}

Profile load_profile(const fs::path& file) {
  const std::string extension = file.extension().string();
  if (!fs::is_regular_file(file))
    throw core::InputError(fmt::format("{}: there is no such sensor file", file.string()));
  if (extension == ".yaml" || extension == ".yml") return from_yaml(file);
  if (extension == ".json") return ouster_profile(file);
  throw core::InputError(fmt::format(
      "{}: a sensor is a .yaml profile (which may name a table: `channels: {}`) or an Ouster metadata .json",
      file.string(), file.filename().string()));
}

}  // namespace tarmac::sim::lidar
