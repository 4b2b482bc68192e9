// SPDX-License-Identifier: GPL-2.0-or-later
// Label images in TIFF files, by libtiff: VTK's reader changes the numbers of files that show 0 as
// white, cannot read tiles in a stack and turns a single page upside down, but not a stack.
#ifndef CALENDEM_ELECTRODE_STRUCTURE_TIFF_IMAGE_H
#define CALENDEM_ELECTRODE_STRUCTURE_TIFF_IMAGE_H

#include <string>

class vtkImageData;
template <class T> class vtkSmartPointer;

namespace calendem {

/// All pages, the first one at the bottom, with rows and numbers as the file stores them, whatever
/// colours and orientation it gives them. Throws Failure(2) unless the file is whole and its pages have one size and one
/// number per voxel.
vtkSmartPointer<vtkImageData> read_tiff(const std::string &file);

} // namespace calendem

#endif
