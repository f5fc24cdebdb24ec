// Voxels: short any-angle ways through free ones, which of them a scan passed, and how far they are from points.
// Coordinates count in voxels: voxel (x, y, z) is the cube from there to (x + 1, y + 1, z + 1).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "parallel.hpp"
#include "paths/air.hpp"

namespace muster {

struct VoxelShape {
  int layers, rows, columns;

  std::size_t count() const { return static_cast<std::size_t>(layers) * rows * columns; }
  std::size_t at(int x, int y, int z) const { return (static_cast<std::size_t>(z) * rows + y) * columns + x; }
  bool holds(int x, int y, int z) const { return x >= 0 && y >= 0 && z >= 0 && x < columns && y < rows && z < layers; }
};

// Short ways by Lazy Theta* ([nash2010]) from voxel to voxel; turns are pulled straight afterwards.
class VoxelWays {
 public:
  VoxelWays(VoxelShape shape, std::vector<std::uint8_t> blocked) : shape_(shape), blocked_(std::move(blocked)) {}

  bool free(Spot p) const;
  // Whether all voxels between two points are free.
  bool sees(Spot a, Spot b) const;
  // The number of the connected part that a point is in; 0 if it is not free.
  std::int32_t part(Spot p);
  // A way with its ends; empty if there is none.
  std::vector<Spot> way(Spot from, Spot to, const Pause& pause);

 private:
  struct Search;

  bool is_free(int x, int y, int z) const { return shape_.holds(x, y, z) && !blocked_[shape_.at(x, y, z)]; }
  // Whether the box of voxels between two neighbours is free, so that the step cuts no corner.
  bool steps(int x, int y, int z, int dx, int dy, int dz) const;
  void number_parts();
  void pull(std::vector<Spot>& way) const;

  VoxelShape shape_;
  std::vector<std::uint8_t> blocked_;
  std::vector<std::int32_t> parts_;  // of the free voxels that are connected; made when first needed
};

// A scan all around: `rings` from straight down to straight up, `columns` anticlockwise from `heading`; how far each
// beam reached.
struct SphereScan {
  Spot eye;
  double heading;
  int rings, columns;
  const double* reached;
};

// The voxels whose centres are nearer than the four beams around them reached, by a voxel at least.
std::vector<std::int64_t> voxels_passed(VoxelShape shape, const SphereScan& scan);

// Lower the distances from the centres of voxels to the nearest of some points, where that is within `reach`.
void lower_clearances(VoxelShape shape, float* clearances, const std::vector<Spot>& points, double reach);

}  // namespace muster
