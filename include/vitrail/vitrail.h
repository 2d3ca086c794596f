// vitrail/vitrail.h: everything that the core library offers.
//
// Glossary. voxel: a cell of the grid; grid: where they are; column: the cells along z above one (x, y); slice: the cells of one z;
// word: 32 slices of a column as bits; tile: 8 x 8 columns of 32 slices; brick: 8^3 voxels; fragment: one triangle in one voxel;
// channel: an attribute of occupied voxels; rank: index of an occupied voxel among all; conservative: every cell touched;
// thin: 6-separating; crossing: a ray passing a surface; transmittance: share of light left; index of refraction: eta.
#pragma once
#include <vitrail/core/device.h>
#include <vitrail/core/error.h>
#include <vitrail/core/queue.h>
#include <vitrail/deform/displace.h>
#include <vitrail/deform/skin.h>
#include <vitrail/grid/camera.h>
#include <vitrail/grid/grid.h>
#include <vitrail/light/boxes.h>
#include <vitrail/light/caustics.h>
#include <vitrail/light/glass.h>
#include <vitrail/light/glass_voxels.h>
#include <vitrail/light/shadow.h>
#include <vitrail/methods.h>
#include <vitrail/metrics/shadow.h>
#include <vitrail/metrics/voxels.h>
#include <vitrail/metrics/watertight.h>
#include <vitrail/scene/mesh.h>
#include <vitrail/scene/scene.h>
#include <vitrail/scene/shapes.h>
#include <vitrail/volume/voxels.h>
#include <vitrail/voxelize/voxelize.h>
