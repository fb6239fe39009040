#pragma once

#include "gcpdda/model/scene.hpp"

#include <hdf5.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace gcpdda::testing {

/// An HDF5 file of blocks, or of nearly blocks: any dataset can be replaced or left out. Written by one
/// process.
class BlockFileWriter {
public:
  struct Dataset {
    hid_t type = -1; ///< in memory and in the file
    std::vector<hsize_t> shape;
    std::vector<char> bytes; ///< none: never written
    bool chunked = false;
  };

  BlockFileWriter() = default;
  explicit BlockFileWriter(const std::vector<SceneBlock> &blocks) {
    std::vector<double> points;
    std::vector<std::int64_t> offsets{0};
    std::vector<std::int32_t> material;
    std::vector<std::uint8_t> fixed;
    std::vector<double> velocity;
    std::vector<std::int32_t> edge_joint;
    for (const SceneBlock &block : blocks) {
      for (const Vec2 p : block.vertices) {
        points.insert(points.end(), {p.x, p.y});
      }
      offsets.push_back(static_cast<std::int64_t>(points.size() / 2));
      material.push_back(block.material);
      fixed.push_back(block.fixed ? 1 : 0);
      velocity.insert(velocity.end(), block.velocity.begin(), block.velocity.end());
      edge_joint.insert(edge_joint.end(), block.edge_joint.begin(), block.edge_joint.end());
    }
    set("points", points, 2);
    set("offsets", offsets);
    set("material", material);
    set("fixed", fixed);
    set("velocity", velocity, 3);
    if (!edge_joint.empty()) { // of all blocks or of none
      set("edge_joint", edge_joint);
    }
  }

  template <class T> void set(const std::string &name, const std::vector<T> &values, hsize_t columns = 1) {
    Dataset &dataset = datasets_[name];
    dataset.type = type_of(T{});
    dataset.shape = {values.size() / columns};
    if (columns > 1) {
      dataset.shape.push_back(columns);
    }
    dataset.bytes.resize(values.size() * sizeof(T));
    if (!values.empty()) {
      std::memcpy(dataset.bytes.data(), values.data(), dataset.bytes.size());
    }
  }
  /// One value of a dataset, as it lies in its rows.
  template <class T> void put(const std::string &name, std::size_t index, T value) {
    std::memcpy(datasets_.at(name).bytes.data() + index * sizeof(T), &value, sizeof(T));
  }
  Dataset &operator[](const std::string &name) { return datasets_[name]; }
  void remove(const std::string &name) { datasets_.erase(name); }
  void rename(const std::string &from, const std::string &to) {
    datasets_[to] = datasets_.at(from);
    datasets_.erase(from);
  }

  void write(const std::filesystem::path &path) const {
    const hid_t file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    for (const auto &[name, dataset] : datasets_) {
      const hid_t creation = H5Pcreate(H5P_DATASET_CREATE);
      if (dataset.chunked) {
        const std::vector<hsize_t> chunk(dataset.shape.size(), 2);
        H5Pset_chunk(creation, static_cast<int>(chunk.size()), chunk.data());
        H5Pset_deflate(creation, 1);
      }
      const hid_t space =
          H5Screate_simple(static_cast<int>(dataset.shape.size()), dataset.shape.data(), nullptr);
      const hid_t id =
          H5Dcreate2(file, name.c_str(), dataset.type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
      if (!dataset.bytes.empty()) {
        H5Dwrite(id, dataset.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, dataset.bytes.data());
      }
      if (id < 0 || H5Dclose(id) < 0 || H5Sclose(space) < 0 || H5Pclose(creation) < 0) {
        throw std::runtime_error("cannot write " + name);
      }
    }
    if (file < 0 || H5Fclose(file) < 0) {
      throw std::runtime_error("cannot write " + path.string());
    }
  }

private:
  static hid_t type_of(double) { return H5T_NATIVE_DOUBLE; }
  static hid_t type_of(float) { return H5T_NATIVE_FLOAT; }
  static hid_t type_of(std::int64_t) { return H5T_NATIVE_INT64; }
  static hid_t type_of(std::int32_t) { return H5T_NATIVE_INT32; }
  static hid_t type_of(std::uint8_t) { return H5T_NATIVE_UINT8; }
  static hid_t type_of(std::int8_t) { return H5T_NATIVE_INT8; }

  std::map<std::string, Dataset> datasets_;
};

} // namespace gcpdda::testing
