// VTK. vtkVoxelModeller marks the samples whose closest point on a triangle lies in their cell, triangle by triangle;
// vtkPolyDataToImageStencil fills closed surfaces, as runs along x through the samples. Both take bounds and spacing; samples are
// the cells' centres. Both are of one thread.
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkImageData.h>
#include <vtkImageStencilData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataToImageStencil.h>
#include <vtkVoxelModeller.h>

#include "peers.h"
#include "timing.h"

namespace vitrail::peers {
namespace {

vtkNew<vtkPolyData> polyData(const Triangles& triangles) {
    vtkNew<vtkPoints> points;
    points->SetNumberOfPoints(vtkIdType(triangles.xyz.size() / 3));
    for (std::size_t i = 0; i < triangles.xyz.size() / 3; ++i) points->SetPoint(vtkIdType(i), &triangles.xyz[3 * i]);
    vtkNew<vtkCellArray> cells;
    for (std::size_t i = 0; i + 2 < triangles.indices.size(); i += 3) {
        const vtkIdType corners[] = {triangles.indices[i], triangles.indices[i + 1], triangles.indices[i + 2]};
        cells->InsertNextCell(3, corners);
    }
    vtkNew<vtkPolyData> mesh;
    mesh->SetPoints(points);
    mesh->SetPolys(cells);
    return mesh;
}

}  // namespace

double vtkModeller(const Triangles& triangles, const native::Grid& grid, unsigned, native::Bits* bits) {
    const vtkNew<vtkPolyData> mesh = polyData(triangles);
    vtkNew<vtkVoxelModeller> modeller;
    modeller->SetInputData(mesh);
    double bounds[6];
    for (int a = 0; a < 3; ++a) {
        bounds[2 * a] = double(grid.origin[a]) + 0.5 * double(grid.edge);  // of the outermost samples
        bounds[2 * a + 1] = bounds[2 * a] + double(grid.edge) * (grid.size[a] - 1);
    }
    modeller->SetModelBounds(bounds);
    modeller->SetSampleDimensions(int(grid.size[0]), int(grid.size[1]), int(grid.size[2]));
    modeller->SetMaximumDistance(1.0 / std::max({grid.size[0], grid.size[1], grid.size[2]}));  // of the longest side: a cell
    modeller->SetScalarTypeToUnsignedChar();
    const double ms = milliseconds([&] { modeller->Update(); });
    if (bits != nullptr) {
        clear(*bits, grid);
        const auto* values = static_cast<const unsigned char*>(modeller->GetOutput()->GetScalarPointer());
        for (std::uint32_t z = 0; z < grid.size[2]; ++z)
            for (std::uint32_t y = 0; y < grid.size[1]; ++y)
                for (std::uint32_t x = 0; x < grid.size[0]; ++x)
                    if (*values++ != 0) set(*bits, x, y, z);
    }
    return ms;
}

double vtkStencil(const Triangles& triangles, const native::Grid& grid, unsigned, native::Bits* bits) {
    const vtkNew<vtkPolyData> mesh = polyData(triangles);
    vtkNew<vtkPolyDataToImageStencil> stencil;
    stencil->SetInputData(mesh);
    const double half = 0.5 * double(grid.edge);
    stencil->SetOutputOrigin(grid.origin[0] + half, grid.origin[1] + half, grid.origin[2] + half);
    stencil->SetOutputSpacing(grid.edge, grid.edge, grid.edge);
    stencil->SetOutputWholeExtent(0, int(grid.size[0]) - 1, 0, int(grid.size[1]) - 1, 0, int(grid.size[2]) - 1);
    stencil->SetTolerance(0);
    const double ms = milliseconds([&] { stencil->Update(); });
    if (bits != nullptr) {
        clear(*bits, grid);
        vtkImageStencilData* inside = stencil->GetOutput();
        for (int z = 0; z < int(grid.size[2]); ++z)
            for (int y = 0; y < int(grid.size[1]); ++y) {
                int first, last, iterator = 0;
                while (inside->GetNextExtent(first, last, 0, int(grid.size[0]) - 1, y, z, iterator) != 0)
                    for (int x = first; x <= last; ++x) set(*bits, x, y, z);
            }
    }
    return ms;
}

}  // namespace vitrail::peers
