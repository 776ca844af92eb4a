// SPDX-License-Identifier: MIT
#include "io/xdmf.hpp"

#include <fmt/format.h>

namespace sphstab::io {
namespace {

/// The text as XML may hold it.
std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

/// Writes the items of one HDF5 file.
class Writer {
 public:
  Writer(const std::string& hdf5_name, std::size_t particles) : file_(escaped(hdf5_name)), particles_(particles) {}

  /// Every particle is a cell of one point.
  std::string topology(const ParticleArray& number) const {
    return fmt::format(
        "        <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\">\n"
        "{}        </Topology>\n",
        particles_, item(number));
  }

  std::string geometry(const ParticleArray& position) const {
    return fmt::format("        <Geometry GeometryType=\"XYZ\">\n{}        </Geometry>\n", item(position));
  }

  std::string attribute(const ParticleArray& array) const {
    const char* type = array.columns == 1 ? "Scalar" : array.columns == 3 ? "Vector" : "Tensor6";
    return fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">\n{}        </Attribute>\n",
                       escaped(array.name), type, item(array));
  }

 private:
  std::string item(const ParticleArray& array) const {
    return fmt::format(
        "          <DataItem Dimensions=\"{}{}\" NumberType=\"{}\" Precision=\"{}\" Format=\"HDF\">"
        "{}:{}</DataItem>\n",
        particles_, array.columns == 1 ? "" : fmt::format(" {}", array.columns), array.whole_numbers ? "Int" : "Float",
        array.whole_numbers ? 4 : 8, file_, escaped(array.data_set));
  }

  std::string file_;
  std::size_t particles_;
};

}  // namespace

std::string xdmf_of_particles(const std::string& hdf5_name, std::size_t particles, const ReferenceArrays& reference,
                              const std::vector<StoredState>& states) {
  const Writer writer(hdf5_name, particles);
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\">\n  <Domain>\n"
      "    <Grid Name=\"states\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const auto& state : states) {
    text += fmt::format("      <Grid Name=\"particles\">\n        <Time Value=\"{}\"/>\n", state.time);
    text += writer.topology(reference.number) + writer.geometry(reference.position);
    for (const auto& array : reference.others) text += writer.attribute(array);
    for (const auto& array : state.arrays) text += writer.attribute(array);
    text += "      </Grid>\n";
  }
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

}  // namespace sphstab::io
