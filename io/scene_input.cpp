// SPDX-License-Identifier: MIT
#include "io/scene_input.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <string_view>
#include <utility>

#include "io/case_input.hpp"
#include "io/toml.hpp"

namespace sphstab::io {
namespace {

using Words = std::vector<std::string_view>;

constexpr std::array<std::string_view, 6> tables{"material", "body", "clamp", "traction", "velocity", "probe"};
constexpr std::array<std::string_view, 3> directions{"x", "y", "z"};
constexpr std::array<std::string_view, 2> arrangements{"lattice", "polar"};

constexpr Limits positive{.low = 0.0, .low_allowed = false};
constexpr Limits at_least_one{.low = 1.0};

/// The keys of the tables, beside those that hold shapes.
const Key keys[] = {
    {"name", KeyKind::text, KeyGroup::body, "", "what messages and results call it"},
    {"material", KeyKind::text, KeyGroup::body, "", "name of a material; default that of the keys of the case"},
    {"arrangement", KeyKind::word, KeyGroup::body, "lattice", "of the particles", {}, arrangements},
    {"offset", KeyKind::numbers, KeyGroup::body, "", "of the first particle, in spacings", {.low = -1.0, .high = 1.0}},
    {"rings", KeyKind::integer, KeyGroup::body, "", "of a polar arrangement", at_least_one},
    {"sectors", KeyKind::integer, KeyGroup::body, "", "of a polar arrangement", at_least_one},
    {"jitter", KeyKind::number, KeyGroup::body, "", "largest displacement in spacings", {.low = 0.0, .high = 0.5}},
    {"jitter_seed", KeyKind::integer, KeyGroup::body, "1", "of the jitter", {.low = 0.0}},
    {"traction", KeyKind::numbers, KeyGroup::body, "", "force per area"},
    {"velocity", KeyKind::numbers, KeyGroup::body, "", "at the start"},
    {"root", KeyKind::number, KeyGroup::body, "", "x where the cantilever is clamped"},
    {"length", KeyKind::number, KeyGroup::body, "", "of the cantilever", positive},
    {"tip", KeyKind::number, KeyGroup::body, "", "velocity of the free end"},
    {"gradient", KeyKind::numbers, KeyGroup::body, "", "of the traction or velocity, row by row"},
    {"origin", KeyKind::numbers, KeyGroup::body, "", "where the traction or velocity has the value given"},
    {"centre", KeyKind::numbers, KeyGroup::body, "", "of radial and shear"},
    {"radial", KeyKind::number, KeyGroup::body, "0", "force per area away from the centre"},
    {"shear", KeyKind::number, KeyGroup::body, "0", "force per area anticlockwise about the centre"},
    {"at_radius", KeyKind::number, KeyGroup::body, "", "of the surface", positive},
    {"force", KeyKind::numbers, KeyGroup::body, "", "total force, per thickness in 2D, shared by mass"},
    {"layer", KeyKind::number, KeyGroup::body, "", "thickness of the particles that carry the load", positive},
    {"position", KeyKind::numbers, KeyGroup::body, "", "near the particle"},
    {"from", KeyKind::numbers, KeyGroup::body, "", "lowest corner of a box"},
    {"to", KeyKind::numbers, KeyGroup::body, "", "highest corner of a box"},
    {"radius", KeyKind::number, KeyGroup::body, "", "of a ball"},
    {"inner", KeyKind::number, KeyGroup::body, "", "radius of an annulus"},
    {"outer", KeyKind::number, KeyGroup::body, "", "radius of an annulus"},
};

const Key& key_of(std::string_view name) {
  return *std::find_if(std::begin(keys), std::end(keys), [&](const Key& key) { return key.name == name; });
}

InvalidInput missing(std::string_view name) { return InvalidInput(fmt::format("{}: missing", name)); }

/// A table of the file. Every key is checked against those that it may have when it is opened.
class Table {
 public:
  Table(const Document& document, const Words& allowed) : document_(document) {
    if (!document.is_object()) throw InvalidInput(fmt::format("{} is no table", document.dump()));
    for (const auto& [key, value] : document.items())
      if (std::find(allowed.begin(), allowed.end(), key) == allowed.end()) throw unknown_word("key", key, allowed);
  }

  bool has(std::string_view name) const { return document_.contains(name); }

  const Document& at(std::string_view name) const {
    if (!has(name)) throw missing(name);
    return document_.at(std::string(name));
  }

  /// The value of the key, or its default; throws where there is neither.
  template <class Type>
  Type value(std::string_view name) const {
    const Key& key = key_of(name);
    if (!has(name) && key.default_value.empty()) throw missing(name);
    const KeyValue value = has(name) ? to_value(std::string(name), at(name)) : parse_value(key, key.default_value);
    check_value(key, value);
    return std::get<Type>(value);
  }

  double number(std::string_view name) const { return value<double>(name); }
  std::string word(std::string_view name) const { return value<std::string>(name); }
  std::optional<double> optional_number(std::string_view name) const {
    return has(name) ? std::optional(number(name)) : std::nullopt;
  }

  template <int Rows, int Columns = 1>
  Eigen::Matrix<double, Rows, Columns> matrix(std::string_view name) const {
    const auto rows = value<std::vector<double>>(name);
    if (rows.size() != Rows * Columns)
      throw InvalidInput(fmt::format("{}: has {} components, but {} are needed", name, rows.size(), Rows * Columns));
    return Eigen::Map<const Eigen::Matrix<double, Columns, Rows>>(rows.data()).transpose();
  }

  /// Throws where one of the keys is there; `why` says which other keys it needs.
  void refuse(const Words& names, std::string_view why) const {
    for (const auto name : names)
      if (has(name)) throw InvalidInput(fmt::format("{}: {}", name, why));
  }

 private:
  const Document& document_;
};

template <int Dim>
Shape<Dim> read_box(const Document& document) {
  const Table table(document, {"from", "to"});
  return Box<Dim>{table.matrix<Dim>("from"), table.matrix<Dim>("to")};
}

template <int Dim>
Shape<Dim> read_ball(const Document& document) {
  const Table table(document, {"centre", "radius"});
  return Ball<Dim>{table.matrix<Dim>("centre"), table.number("radius")};
}

template <int Dim>
Shape<Dim> read_annulus(const Document& document) {
  const Table table(document, {"centre", "inner", "outer"});
  return Annulus<Dim>{table.matrix<Dim>("centre"), table.number("inner"), table.number("outer")};
}

/// { box = { … } }, { ball = { … } } or { annulus = { … } }.
template <int Dim>
Shape<Dim> read_shape(const Document& document) {
  const std::pair<std::string_view, Shape<Dim> (*)(const Document&)> kinds[] = {
      {"box", read_box<Dim>}, {"ball", read_ball<Dim>}, {"annulus", read_annulus<Dim>}};
  const Table table(document, {"box", "ball", "annulus"});
  if (document.size() != 1) throw InvalidInput("is not one of box, ball and annulus");
  for (const auto& [name, read] : kinds)
    if (table.has(name)) return in_context(name, [&, read = read, name = name] { return read(table.at(name)); });
  return {};
}

template <int Dim>
Shape<Dim> shape_at(const Table& table, std::string_view key) {
  const Document& document = table.at(key);
  return in_context(key, [&] { return read_shape<Dim>(document); });
}

/// The tables of a file in the order of the text.
template <int Dim>
class SceneReader {
 public:
  explicit SceneReader(SceneDescription<Dim>& scene) : scene_(scene) {}

  void read(const Document& file) {
    for_each_of(file, "material", [&](const Document& document) { read_material(document); });
    for_each_of(file, "body", [&](const Document& document) { read_body(document); });
    for_each_of(file, "clamp", [&](const Document& document) { read_clamp(document); });
    for_each_of(file, "traction", [&](const Document& document) { read_traction(document); });
    for_each_of(file, "velocity", [&](const Document& document) { read_velocity(document); });
    for_each_of(file, "probe", [&](const Document& document) { read_probe(document); });
  }

 private:
  template <class Read>
  static void for_each_of(const Document& file, const std::string& table, const Read& read) {
    if (!file.contains(table)) return;
    int number = 0;
    for (const Document& entry : file.at(table))
      in_context(fmt::format("{} {}", table, ++number), [&] { read(entry); });
  }

  void read_material(const Document& document) {
    const Table table(document, {"name", "density", "young_modulus", "poisson_ratio", "bulk_modulus", "shear_modulus",
                                 "sound_speed"});
    const std::string name = table.word("name");
    if (std::find(material_names_.begin(), material_names_.end(), name) != material_names_.end())
      throw InvalidInput(fmt::format("name: '{}' is given twice", name));
    Document keys_of_case = document;
    keys_of_case.erase("name");
    Case input;
    set_from_json(input, keys_of_case);
    material_names_.push_back(name);
    scene_.materials.push_back(make_material(input));
  }

  void read_body(const Document& document) {
    const Table table(document, {"name", "material", "shape", "arrangement", "offset", "rings", "sectors", "cut",
                                 "jitter", "jitter_seed"});
    ScenePart<Dim> part{.name = table.has("name") ? table.word("name") : "",
                        .placement = {.shape = shape_at<Dim>(table, "shape"), .arrangement = read_arrangement(table)},
                        .material = table.has("material") ? material_index(table.word("material")) : 0};
    if (table.has("cut")) {
      if (!table.at("cut").is_array()) throw InvalidInput("cut: is no list of shapes");
      for (const Document& hole : table.at("cut"))
        part.placement.cut.push_back(in_context("cut", [&] { return read_shape<Dim>(hole); }));
    }
    if (table.has("jitter"))
      part.placement.jitter = {table.number("jitter"), static_cast<std::uint64_t>(table.number("jitter_seed"))};
    else
      table.refuse({"jitter_seed"}, "only with jitter");
    scene_.parts.push_back(std::move(part));
  }

  int material_index(const std::string& name) const {
    const auto found = std::find(material_names_.begin(), material_names_.end(), name);
    if (found == material_names_.end())
      throw material_names_.empty()
          ? InvalidInput(fmt::format("material: '{}' is not known; the file has no table material", name))
          : unknown_word("material", name, Words(material_names_.begin(), material_names_.end()));
    return 1 + static_cast<int>(found - material_names_.begin());  // after the default
  }

  static Arrangement<Dim> read_arrangement(const Table& table) {
    if (table.word("arrangement") == "polar") {
      table.refuse({"offset"}, "only with the arrangement lattice");
      return PolarArrangement{static_cast<int>(table.number("rings")), static_cast<int>(table.number("sectors"))};
    }
    table.refuse({"rings", "sectors"}, "only with the arrangement polar");
    if (!table.has("offset")) return LatticeArrangement<Dim>{};
    return LatticeArrangement<Dim>{table.matrix<Dim>("offset")};
  }

  void read_clamp(const Document& document) {
    const Table table(document, {"region", "directions"});
    scene_.clamps.push_back({shape_at<Dim>(table, "region"), read_directions(table)});
  }

  static Directions<Dim> read_directions(const Table& table) {
    if (!table.has("directions")) return Directions<Dim>::Constant(true);
    const Words allowed(directions.begin(), directions.begin() + Dim);
    const Document& list = table.at("directions");
    if (!list.is_array() || list.empty()) throw InvalidInput("directions: is no list of directions");
    Directions<Dim> held = Directions<Dim>::Constant(false);
    for (const Document& entry : list) {
      const auto word = entry.is_string() ? entry.get<std::string>() : entry.dump();
      const auto found = std::find(allowed.begin(), allowed.end(), word);
      if (found == allowed.end()) throw unknown_word("directions", word, allowed);
      held[found - allowed.begin()] = true;
    }
    return held;
  }

  void read_traction(const Document& document) {
    const Table table(document, {"region", "traction", "gradient", "origin", "centre", "radial", "shear", "at_radius",
                                 "layer", "force"});
    scene_.tractions.push_back({shape_at<Dim>(table, "region"), read_stress(table), table.optional_number("layer")});
  }

  static decltype(Traction<Dim>::stress) read_stress(const Table& table) {
    if (table.has("force")) {
      table.refuse({"traction", "gradient", "origin", "centre", "radial", "shear", "at_radius", "layer"},
                   "cannot be given with force");
      return TotalForce<Dim>{table.matrix<Dim>("force")};
    }
    if (table.has("traction")) {
      table.refuse({"centre", "radial", "shear", "at_radius"}, "cannot be given with traction");
      return read_affine(table, "traction");
    }
    table.refuse({"gradient", "origin"}, "only with traction");
    if (!table.has("radial") && !table.has("shear"))
      throw InvalidInput("traction: missing (or force, or radial or shear with centre)");
    return CentredTraction<Dim>{.centre = table.matrix<Dim>("centre"),
                                .radial = table.number("radial"),
                                .shear = table.number("shear"),
                                .at_radius = table.optional_number("at_radius")};
  }

  static AffineField<Dim> read_affine(const Table& table, std::string_view value) {
    AffineField<Dim> affine{.value = table.matrix<Dim>(value)};
    if (table.has("gradient")) affine.gradient = table.matrix<Dim, Dim>("gradient");
    if (table.has("origin")) affine.origin = table.matrix<Dim>("origin");
    return affine;
  }

  void read_velocity(const Document& document) {
    const Table table(document, {"region", "velocity", "gradient", "origin", "cantilever"});
    const auto region = shape_at<Dim>(table, "region");
    if (!table.has("cantilever") && !table.has("velocity")) throw InvalidInput("velocity: missing (or cantilever)");
    if (!table.has("cantilever")) return scene_.velocities.push_back({region, read_affine(table, "velocity")});
    table.refuse({"velocity", "gradient", "origin"}, "cannot be given with cantilever");
    const Document& cantilever = table.at("cantilever");
    scene_.velocities.push_back(
        {region, in_context("cantilever", [&] {
           const Table mode(cantilever, {"root", "length", "tip"});
           return CantileverMode{mode.number("root"), mode.number("length"), mode.number("tip")};
         })});
  }

  void read_probe(const Document& document) {
    const Table table(document, {"name", "position"});
    scene_.probes.push_back({table.word("name"), table.matrix<Dim>("position")});
  }

  SceneDescription<Dim>& scene_;
  std::vector<std::string> material_names_;  ///< of the materials of the scene after the first
};

/// Throws unless every table of the file is one of a scene and an array of tables; returns the keys of the case.
Document keys_of_case(const Document& file) {
  Document keys_found = Document::object();
  for (const auto& [key, value] : file.items()) {
    const bool is_table = std::find(tables.begin(), tables.end(), key) != tables.end();
    const bool holds_tables =
        value.is_array() && !value.empty() &&
        std::all_of(value.begin(), value.end(), [](const Document& entry) { return entry.is_object(); });
    if (is_table && !holds_tables) throw InvalidInput(fmt::format("{0}: is no array of tables, [[{0}]]", key));
    if (!is_table && (holds_tables || value.is_object())) throw unknown_word("table", key, tables);
    if (key == "scene") throw InvalidInput("scene: a scene file names no other scene");
    if (!is_table) keys_found[key] = value;
  }
  return keys_found;
}

}  // namespace

Case with_scene_keys(const Case& input) {
  const auto path = input.word("scene");
  if (!path) return input;
  const Document file = read_toml(*path);
  Case keys_of_scene;
  in_context(*path, [&] { set_from_json(keys_of_scene, keys_of_case(file)); });
  return keys_of_scene.under(input);
}

template <int Dim>
Scene<Dim> read_scene(const Case& input) {
  const std::string path = input.required_word("scene");
  const auto problem = make_problem<Dim>(input);
  SceneDescription<Dim> description{.name = std::filesystem::path(path).stem().string(),
                                    .problem = problem,
                                    .materials = {problem.material},
                                    .parts = {},
                                    .periodic_cells = make_counts<Dim>(input, "patch")};
  description.gravity = make_gravity<Dim>(input);
  const Document file = read_toml(path);
  return in_context(path, [&] {
    SceneReader<Dim>(description).read(file);
    return make_scene(description);
  });
}

template Scene<1> read_scene(const Case&);
template Scene<2> read_scene(const Case&);
template Scene<3> read_scene(const Case&);

}  // namespace sphstab::io
