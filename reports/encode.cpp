// Images to PNG and JPEG, by VTK's writers.
#include <vtkImageData.h>
#include <vtkJPEGWriter.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkSmartPointer.h>
#include <vtkUnsignedCharArray.h>

#include <cstring>

#include "reports/stills.h"

namespace tarmac::reports {

namespace {

vtkSmartPointer<vtkImageData> to_vtk(const Image& image) {
  vtkNew<vtkImageData> data;
  data->SetDimensions(image.width_px, image.height_px, 1);
  data->AllocateScalars(VTK_UNSIGNED_CHAR, 3);
  const std::size_t row_bytes = std::size_t(3) * image.width_px;
  for (int y = 0; y < image.height_px; ++y) {
    std::memcpy(data->GetScalarPointer(0, image.height_px - 1 - y, 0), image.rgb.data() + y * row_bytes, row_bytes);
  }
  return data.Get();
}

template <class Writer>
std::string encode(Writer* writer, const Image& image) {
  writer->SetInputData(to_vtk(image));
  writer->WriteToMemoryOn();
  writer->Write();
  vtkUnsignedCharArray* const bytes = writer->GetResult();
  return {reinterpret_cast<const char*>(bytes->GetPointer(0)), static_cast<std::size_t>(bytes->GetNumberOfTuples())};
}

}  // namespace

std::string to_png(const Image& image) {
  vtkNew<vtkPNGWriter> writer;
  return encode(writer.Get(), image);
}

std::string to_jpeg(const Image& image, int quality_percent) {
  vtkNew<vtkJPEGWriter> writer;
  writer->SetQuality(quality_percent);
  return encode(writer.Get(), image);
}

}  // namespace tarmac::reports
