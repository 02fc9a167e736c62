// The two-dimensional part of a picture, drawn by VTK's overlay.
#include "io/pictures/render_sheet.hpp"

#include <vtkActor2D.h>
#include <vtkCellArray.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper2D.h>
#include <vtkProperty2D.h>
#include <vtkRenderer.h>
#include <vtkTextActor.h>
#include <vtkTextProperty.h>
#include <vtkTextRenderer.h>

namespace talus::render {

Vec3 channels(const Colour& colour) { return Vec3(colour[0], colour[1], colour[2]) / 255; }

void Sheet::polygon(const std::vector<std::array<Real, 2>>& corners, const Colour& colour, bool filled)
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> cells;
  cells->InsertNextCell(static_cast<int>(corners.size()));
  for (const auto& [x, y] : corners)
    cells->InsertCellPoint(points->InsertNextPoint(x, y, 0));
  vtkNew<vtkPolyData> data;
  data->SetPoints(points);
  if (filled)
    data->SetPolys(cells);
  else
    data->SetLines(cells);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(data);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);
  actor->GetProperty()->SetColor(channels(colour).data());
  actor->GetProperty()->SetLineWidth(static_cast<float>(0.09 * letter_));
  renderer_->AddActor2D(actor);
}

Real Sheet::text(const std::string& words, Real x, Real y, Side side, Style style)
{
  vtkNew<vtkTextActor> actor;
  actor->SetInput(words.c_str());
  vtkTextProperty* font = actor->GetTextProperty();
  font->SetFontFamilyToArial();
  font->SetFontSize(static_cast<int>(style.size * letter_));
  font->SetBold(style.bold ? 1 : 0);
  font->SetOrientation(style.vertical ? 90 : 0);
  font->SetColor(channels(ink).data());
  font->SetBackgroundColor(1, 1, 1);  // lines of the mesh may pass behind the text
  font->SetBackgroundOpacity(words.empty() ? 0 : 0.8);
  font->SetJustification(side == Side::left ? VTK_TEXT_LEFT : side == Side::centre ? VTK_TEXT_CENTERED : VTK_TEXT_RIGHT);
  font->SetVerticalJustificationToCentered();
  actor->SetPosition(x, y);
  renderer_->AddActor2D(actor);
  std::array<int, 4> box{};
  constexpr int dpi = 72;  // value of every vtkRenderWindow
  vtkTextRenderer::GetInstance()->GetBoundingBox(font, words, box.data(), dpi);
  return style.vertical ? box[3] - box[2] : box[1] - box[0];
}

}  // namespace talus::render
