#include "tassilo/app/training_requests.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <span>
#include <vector>

#include "tassilo/app/frame_bytes.h"
#include "tassilo/base/error.h"
#include "tassilo/files/json.h"

namespace tassilo {
namespace {

using nlohmann::json;

constexpr std::string_view kPath = "/api/training";

WebResponse said(const json& value) {
  return {200, "application/json", value.dump(-1, ' ', false, json::error_handler_t::replace)};
}

/// RFC 4648, with padding.
std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr std::string_view letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return i + k < bytes.size() ? unsigned{bytes[i + k]} : 0u; };
    const unsigned three = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? letters[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

json interval_json(const BrightnessInterval& interval) { return {interval.low, interval.high}; }

json table_json(const ColorTable& table) {
  json brightness = json::object(), priority = json::array();
  for (const ColorClass color : kColorClasses) {
    const auto& interval = table.brightness[static_cast<std::size_t>(class_index(color))];
    if (interval.low <= interval.high) brightness[std::string(to_string(color))] = interval_json(interval);
  }
  for (const ColorClass color : table.priority) priority.push_back(to_string(color));
  return {{"chroma", base64(table.chroma)},
          {"brightness", std::move(brightness)},
          {"priority", std::move(priority)},
          {"range", to_string(table.range)}};
}

json image_json(const TrainingSession::Image& image) {
  const Frame frame = frame_of_bytes(image.bytes);
  return {{"id", image.id},
          {"name", image.name},
          {"width", frame.view.width()},
          {"height", frame.view.height()},
          {"kept", !image.file.empty()}};
}

json share_json(const std::optional<double>& share) { return share ? json(*share) : json(nullptr); }

json options_json(const TrainingOptions& options) {
  json list = json::array();
  for (const TrainingNumber& number : training_numbers())
    list.push_back({{"key", number.key},
                    {"unit", number.unit},
                    {"low", number.low},
                    {"high", number.high},
                    {"whole", number.whole != nullptr},
                    {"meaning", number.meaning},
                    {"default", number.of({})},
                    {"value", number.of(options)},
                    {"changed", number.of(options) != number.of({})}});
  return list;
}

/// "2026-11-28T01:02:03Z" of the id "2026-11-28T01-02-03Z-2"; other names that people gave stay as they are.
std::string date_of(std::string id) {
  constexpr std::size_t length = 20;
  if (id.size() < length || id[10] != 'T' || id[length - 1] != 'Z') return id;
  id.resize(length);
  id[13] = id[16] = ':';
  return id;
}

json history_json(const std::vector<FormerColors>& history, const ColorTable& in_use) {
  json list = json::array();
  for (const FormerColors& former : history) {
    json quality = json::object();
    std::string notes = former.fault.empty() ? "" : "cannot be read: " + former.fault;
    if (former.colors.trained_from) {
      notes = former.colors.trained_from->notes;
      for (const auto& [color, one] : former.colors.trained_from->quality)
        quality[std::string(to_string(color))] = {{"precision", share_json(one.precision)},
                                                  {"recall", share_json(one.recall)}};
    }
    list.push_back({{"id", former.id},
                    {"date", date_of(former.id)},
                    {"notes", std::move(notes)},
                    {"in_use", former.fault.empty() && former.colors.table == in_use},
                    {"quality", std::move(quality)}});
  }
  return list;
}

WebResponse state_response(const TrainingSession& session, const ColorTable& in_use) {
  const TrainingSession::State state = session.state();
  json images = json::array(), samples = json::array(), brightness = json::object();
  for (const TrainingSession::Image& image : state.images) images.push_back(image_json(image));
  for (const DraftSample& sample : state.samples) samples.push_back(json::parse(draft_sample_json(sample)));
  for (const ColorClass color : kColorClasses)
    if (const auto& interval = state.options.brightness[static_cast<std::size_t>(class_index(color))])
      brightness[std::string(to_string(color))] = interval_json(*interval);
  return said({{"version", state.version},
               {"is_saved", state.is_saved},
               {"range", to_string(state.range)},
               {"files",
                {{"samples", state.files.samples.string()},
                 {"colors", state.files.colors.string()},
                 {"images", state.files.images().string()},
                 {"refusal", state.refusal}}},
               {"images", std::move(images)},
               {"samples", std::move(samples)},
               {"options", options_json(state.options)},
               {"brightness", std::move(brightness)},
               {"history", history_json(state.history, in_use)}});
}

/// Histograms of all samples of a class.
json seen_json(const TrainingSession::Result& result, ColorClass color) {
  std::vector<int> cells(256 * 256);
  std::array<std::int64_t, 256> brightness{};
  for (const auto& sample : result.samples) {
    if (sample->color != color) continue;
    for (const YuvPixel& pixel : sample->pixels) {
      ++cells[static_cast<std::size_t>(pixel.v * 256 + pixel.u)];
      ++brightness[pixel.y];
    }
  }
  const int most = *std::ranges::max_element(cells);
  std::vector<std::uint8_t> density(cells.size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (cells[i] > 0)
      density[i] =
          static_cast<std::uint8_t>(most > 1 ? 1 + std::lround(254 * std::log(cells[i]) / std::log(most)) : 255);
  return {{"class", to_string(color)}, {"density", base64(density)}, {"most", most}, {"brightness", brightness}};
}

WebResponse result_response(const TrainingSession::Result& result, const std::string& query) {
  std::optional<ColorClass> seen;
  if (const auto name = query_value(query, "class")) {
    seen = color_class_from(*name);
    if (!seen) return refusal(400, "class is '" + *name + "', must be no_color or a color class");
  }
  std::array<std::int64_t, kColorClassCount + 1> samples{}, pixels{};
  for (const auto& sample : result.samples) {
    ++samples[static_cast<std::size_t>(sample->color)];
    pixels[static_cast<std::size_t>(sample->color)] += static_cast<std::int64_t>(sample->pixels.size());
  }
  json classes = json::array();
  for (std::size_t k = 0; k < samples.size(); ++k)
    classes.push_back(
        {{"class", to_string(static_cast<ColorClass>(k))}, {"samples", samples[k]}, {"pixels", pixels[k]}});
  return said({{"version", result.version},
               {"table", table_json(result.table)},
               {"classes", std::move(classes)},
               {"seen", seen ? seen_json(result, *seen) : json(nullptr)},
               {"warnings", result.warnings}});
}

WebResponse quality_response(const TrainingSession::JudgedQuality& judged) {
  json classes = json::object();
  for (const ColorClass color : kColorClasses)
    if (judged.quality.pixels(color) > 0)
      classes[std::string(to_string(color))] = {{"precision", share_json(judged.quality.precision(color))},
                                                {"recall", share_json(judged.quality.recall(color))},
                                                {"pixels", judged.quality.pixels(color)}};
  return said({{"version", judged.version ? json(*judged.version) : json(nullptr)},
               {"is_running", judged.is_running},
               {"classes", std::move(classes)}});
}

/// What is asked, read before anything is done: what cannot be read is the asker's fault, 400.
template <class Read>
auto asked(Read read, WebResponse& no) -> std::optional<decltype(read())> {
  try {
    return read();
  } catch (const Error& error) {
    no = refusal(400, error.what());
    return std::nullopt;
  }
}

std::optional<std::int64_t> frame_of(const std::string& body) {
  const auto frame = parse_json(body, "request").map({"frame"}).find("frame");
  return frame && !frame->is_null() ? std::optional(frame->integer(0)) : std::nullopt;
}

struct SaveRequest {
  std::int64_t version = 0;
  std::string notes;
};
SaveRequest save_request_of(const std::string& body) {
  constexpr std::size_t longest_note = 1000;
  const Map map = parse_json(body, "request").map({"version", "notes"});
  SaveRequest request{map.at("version").integer(0), ""};
  if (const auto notes = map.find("notes"); notes && notes->setting().text != "") request.notes = notes->string();
  if (request.notes.size() > longest_note) throw Error("notes", "are too long, must be at most 1000 bytes");
  return request;
}

WebResponse answer_image(TrainingSession& session, const WebRequest& request, const std::string& id,
                         const TrainingRun& run) {
  if (request.method == "GET") {
    const auto image = session.image(id);
    return image ? WebResponse{200, "application/octet-stream", *image->bytes}
                 : refusal(404, "there is no such picture");
  }
  if (request.method == "DELETE")
    return session.remove_image(id) ? state_response(session, run.table_in_use())
                                    : refusal(404, "there is no such picture");
  return refusal(405, "a picture is read by GET and forgotten by DELETE");
}

WebResponse answer_post(TrainingSession& session, const std::string& what, const std::string& body,
                        const TrainingRun& run) {
  WebResponse no;
  if (what == "/images") {
    const auto frame = asked([&] { return frame_of(body); }, no);
    if (!frame) return no;
    const auto bytes = run.frame(*frame);
    return bytes ? said(image_json(session.add_image(bytes))) : refusal(503, "no frame comes");
  }
  if (what == "/save") {
    const auto request = asked([&] { return save_request_of(body); }, no);
    if (!request) return no;
    session.save(request->version, request->notes);
  } else {
    const auto id = asked([&] { return parse_json(body, "request").map({"id"}).at("id").string(); }, no);
    if (!id) return no;
    if (!session.restore(*id)) return refusal(404, *id + " is no table of the history");
  }
  try {
    run.take_over();
  } catch (const std::exception& error) {
    return refusal(409,
                   std::string("the files are written, but the run goes on with the table before: ") + error.what());
  }
  return state_response(session, run.table_in_use());
}

}  // namespace

WebResponse answer_training(TrainingSession& session, const WebRequest& request, const TrainingRun& run) {
  const std::string what = request.path.substr(kPath.size());
  constexpr std::string_view images = "/images/";
  try {
    if (what.starts_with(images)) return answer_image(session, request, what.substr(images.size()), run);
    if (what == "/images" || what == "/save" || what == "/restore")
      return request.method == "POST" ? answer_post(session, what, request.body, run)
                                      : refusal(405, "must be asked by POST");
    if (what == "/draft") {
      if (request.method != "PUT") return refusal(405, "the draft is set by PUT");
      WebResponse no;
      auto draft = asked([&] { return draft_from_json(request.body, "request"); }, no);
      return draft ? result_response(session.set_draft(std::move(*draft)), request.query) : no;
    }
    if (request.method != "GET" && request.method != "HEAD") return refusal(405, "must be read by GET");
    if (what.empty()) return state_response(session, run.table_in_use());
    if (what == "/result") return result_response(session.result(), request.query);
    if (what == "/quality") return quality_response(session.quality());
    if (what == "/table") return said(table_json(run.table_in_use()));
    return refusal(404, "there is nothing at " + request.path);
  } catch (const Error& error) {
    return refusal(409, error.what());
  }
}

}  // namespace tassilo
