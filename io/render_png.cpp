// Off-screen windows with VTK.
#include "io/render_png.hpp"

#include <fmt/format.h>
#include <vtkImageShrink3D.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkWindowToImageFilter.h>

#include "core/error.hpp"

namespace talus::render {

namespace fs = std::filesystem;

void prepare(vtkRenderWindow* window, const std::array<int, 2>& size)
{
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetSize(oversampling * size[0], oversampling * size[1]);
}

void save(vtkRenderWindow* window, const fs::path& png)
{
  window->Render();
  vtkNew<vtkWindowToImageFilter> shot;
  shot->SetInput(window);
  shot->ReadFrontBufferOff();
  vtkNew<vtkImageShrink3D> averaged;
  averaged->SetInputConnection(shot->GetOutputPort());
  averaged->SetShrinkFactors(oversampling, oversampling, 1);
  averaged->AveragingOn();
  const fs::path temporary = png.string() + ".tmp";
  vtkNew<vtkPNGWriter> writer;
  writer->SetFileName(temporary.c_str());
  writer->SetInputConnection(averaged->GetOutputPort());
  writer->Write();
  std::error_code failed;
  if (writer->GetErrorCode() == 0)
    fs::rename(temporary, png, failed);
  if (writer->GetErrorCode() != 0 || failed) {
    fs::remove(temporary, failed);
    throw EnvironmentError(fmt::format("cannot write {}", png.string()));
  }
}

}  // namespace talus::render
