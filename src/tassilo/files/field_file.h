#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tassilo/field/field_model.h"

namespace tassilo {

/// Folders that may hold shipped files (fields/, robots/, ...), first hit wins: $TASSILO_CONFIG_DIR,
/// share/tassilo/config of the installation (beside the running program's bin, then above the library or module that
/// holds this code, then the prefix it was built for), config/ of the source tree. Each folder once, however it is
/// spelled.
std::vector<std::filesystem::path> config_folders();

/// A field is named by a path when there is a slash or a .yaml ending in it, else by a shipped name.
bool is_field_path(std::string_view name_or_path);

/// The field of a path or of a shipped name (msl98, rcj_soccer, ...), looked up as fields/NAME.yaml in `folders`.
/// Throws Error; for an unknown name it lists the shipped ones.
FieldModel read_field(const std::string& name_or_path, std::span<const std::filesystem::path> folders);
FieldModel read_field(const std::string& name_or_path);

/// The text of such a file; reading it gives the same field, to the last bit, but for the name.
std::string field_yaml(const FieldModel& field);

/// The content of a field file; `file` names it in messages, its stem becomes the field's name.
FieldModel field_from_yaml(std::string_view text, const std::filesystem::path& file);

}  // namespace tassilo
