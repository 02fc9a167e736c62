// Off-screen windows with VTK.
#include "io/pictures/render_png.hpp"

#include <fmt/format.h>
#include <vtkImageShrink3D.h>
#include <vtkNew.h>
#include <vtkPNGWriter.h>
#include <vtkRenderWindow.h>
#include <vtkWindowToImageFilter.h>

#include "core/error.hpp"
#include "io/files/atomic_file.hpp"

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
  write_whole(png, [&](const fs::path& temporary) {
    vtkNew<vtkPNGWriter> writer;
    writer->SetFileName(temporary.c_str());
    writer->SetInputConnection(averaged->GetOutputPort());
    writer->Write();
    if (writer->GetErrorCode() != 0)
      throw EnvironmentError(fmt::format("cannot write {}", png.string()));
  });
}

}  // namespace talus::render
