// Charts by VTK, from a table in a file.
#include "io/pictures/render_chart.hpp"

#include <fmt/format.h>
#include <vtkAxis.h>
#include <vtkChartLegend.h>
#include <vtkChartXY.h>
#include <vtkContextActor.h>
#include <vtkContextScene.h>
#include <vtkDelimitedTextReader.h>
#include <vtkDoubleArray.h>
#include <vtkNew.h>
#include <vtkPen.h>
#include <vtkPlot.h>
#include <vtkRenderWindow.h>
#include <vtkRenderer.h>
#include <vtkStringArray.h>
#include <vtkTable.h>
#include <vtkTextProperty.h>

#include <algorithm>
#include <cmath>

#include "core/display_text.hpp"
#include "core/error.hpp"
#include "core/word_match.hpp"
#include "io/pictures/render_png.hpp"
#include "io/pictures/render_sheet.hpp"
#include "io/pictures/render_words.hpp"

namespace talus::render {

namespace {

constexpr std::array<int, 2> size{960, 600};  // in pixels
constexpr int letter = 15 * oversampling;     // in pixels
constexpr Real headroom = 0.05;               // fraction of the range of y, above and below

/// Colours of Okabe and Ito (2008), distinguishable with any kind of colour blindness.
constexpr std::array<Colour, 7> palette{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {230, 159, 0}, {86, 180, 233}, {90, 90, 90}}};

/// Splits "axial_strain [-]" into name and unit.
std::pair<std::string, std::string> split(const std::string& column)
{
  const auto bracket = column.find(" [");
  std::string name = column.substr(0, bracket);
  std::replace(name.begin(), name.end(), '_', ' ');
  return {name, bracket == std::string::npos ? "-" : column.substr(bracket + 2, column.size() - bracket - 3)};
}

vtkDataArray* column_of(vtkTable* table, const std::string& name)
{
  if (auto* column = vtkDataArray::SafeDownCast(table->GetColumnByName(name.c_str())))
    return column;
  std::vector<std::string> known;
  for (vtkIdType i = 0; i < table->GetNumberOfColumns(); ++i)
    known.emplace_back(table->GetColumnName(i));
  throw Error(fmt::format("no column of numbers \"{}\"{}", name, suggestion(name, known)));
}

vtkSmartPointer<vtkTable> curve(const std::string& name, const std::vector<Real>& x, const std::vector<Real>& y)
{
  auto table = vtkSmartPointer<vtkTable>::New();
  for (const auto& [title, values] : {std::pair{std::string("x"), &x}, std::pair{name, &y}}) {
    vtkNew<vtkDoubleArray> column;
    column->SetName(title.c_str());
    for (const Real value : *values)
      column->InsertNextValue(value);
    table->AddColumn(column);
  }
  return table;
}

void add(vtkChartXY* chart, vtkTable* table, std::size_t number)
{
  vtkPlot* plot = chart->AddPlot(vtkChart::LINE);
  plot->SetInputData(table, 0, 1);
  const Colour& colour = palette[number % palette.size()];
  plot->SetColor(colour[0], colour[1], colour[2], 255);
  plot->SetWidth((number == 0 ? 2.5F : 1.8F) * oversampling);
  if (number > 0)
    plot->GetPen()->SetLineType(number % 2 == 1 ? vtkPen::DASH_LINE : vtkPen::DASH_DOT_LINE);
}

void letter_axis(vtkAxis* axis, const std::string& title)
{
  axis->SetTitle(title);
  axis->GetTitleProperties()->SetFontSize(letter);
  axis->GetTitleProperties()->BoldOff();
  axis->GetLabelProperties()->SetFontSize(letter);
  axis->GetGridPen()->SetColor(225, 225, 225);
  axis->GetPen()->SetWidth(oversampling);
}

/// Sets the range of an axis from `low` to `high` with a relative margin on either side, and round tick marks.
void show_span(vtkAxis* axis, Real low, Real high, Real margin)
{
  low -= margin * (high - low);
  high += margin * (high - low);
  axis->SetBehavior(vtkAxis::FIXED);
  axis->SetRange(low, high);
  vtkNew<vtkDoubleArray> places;
  vtkNew<vtkStringArray> words;
  for (const auto& [value, text] : ticks(low, high)) {
    places->InsertNextValue(value);
    words->InsertNextValue(text);
  }
  axis->SetCustomTickPositions(places, words);
}

/// Merges levels of equal height, which share a line and a label.
std::vector<Chart::Level> merged(const std::vector<Chart::Level>& levels)
{
  std::vector<Chart::Level> lines;
  for (const Chart::Level& level : levels) {
    const auto same = [&](const Chart::Level& line) { return std::abs(line.value - level.value) <= 1e-9 * std::abs(level.value); };
    if (const auto line = std::find_if(lines.begin(), lines.end(), same); line != lines.end())
      line->name += ", " + level.name;
    else
      lines.push_back(level);
  }
  return lines;
}

std::vector<Real> values_of(vtkDataArray* column, Real factor = 1)
{
  std::vector<Real> values;
  for (vtkIdType i = 0; i < column->GetNumberOfTuples(); ++i)
    values.push_back(factor * column->GetTuple1(i));
  return values;
}

/// The range of x.
std::pair<Real, Real> reach_along(const Chart& chart, const std::vector<Real>& x)
{
  if (x.empty())
    throw Error(fmt::format("{} has no rows to draw", chart.table.string()));
  const auto [low, high] = std::pair{*std::min_element(x.begin(), x.end()), *std::max_element(x.begin(), x.end())};
  return {low, low < high ? high : low + 1};
}

void put_on_paper(vtkChartXY* plot, const std::filesystem::path& out)
{
  vtkNew<vtkRenderWindow> window;
  prepare(window, size);
  vtkNew<vtkRenderer> paper;
  paper->SetBackground(1, 1, 1);
  window->AddRenderer(paper);
  vtkNew<vtkContextActor> actor;
  actor->GetScene()->AddItem(plot);
  actor->GetScene()->SetRenderer(paper);
  paper->AddActor(actor);
  save(window, out);
}

void letter_chart(vtkChartXY* plot, const std::string& title)
{
  plot->SetTitle(title);
  plot->GetTitleProperties()->SetFontSize(letter);
  plot->SetHiddenAxisBorder(2 * letter);  // for half of the last number, and above the title: both lie outside the frame
  plot->SetShowLegend(true);
  plot->GetLegend()->SetLabelSize(letter);
  plot->GetLegend()->SetHorizontalAlignment(vtkChartLegend::RIGHT);
  plot->GetLegend()->SetVerticalAlignment(vtkChartLegend::BOTTOM);
}

}  // namespace

void draw(const Chart& chart)
{
  if (!std::filesystem::exists(chart.table))
    throw EnvironmentError(fmt::format("there is no {}", chart.table.string()));
  vtkNew<vtkDelimitedTextReader> reader;
  reader->SetFileName(chart.table.c_str());
  reader->SetHaveHeaders(true);
  reader->DetectNumericColumnsOn();
  reader->SetForceDouble(true);
  reader->Update();
  vtkTable* table = reader->GetOutput();
  const auto [x_name, x_unit] = split(chart.x);
  const auto [y_name, y_unit] = split(chart.y);
  vtkDataArray* y_column = column_of(table, chart.y);
  Real low = std::min(0.0, y_column->GetRange()[0]), high = std::max(0.0, y_column->GetRange()[1]);
  for (const Chart::Level& level : chart.levels) {
    low = std::min(low, level.value);
    high = std::max(high, level.value);
  }
  const ScaledUnit unit = scaled_unit(y_unit, std::max(-low, high));
  const std::vector<Real> x = values_of(column_of(table, chart.x));
  const std::vector<Real> y = values_of(y_column, unit.factor);
  low *= unit.factor, high *= unit.factor;

  vtkNew<vtkChartXY> plot;
  letter_chart(plot, chart.title);
  letter_axis(plot->GetAxis(vtkAxis::BOTTOM), fmt::format("{} [{}]", x_name, x_unit));
  letter_axis(plot->GetAxis(vtkAxis::LEFT), fmt::format("{} [{}]", y_name, unit.name));
  const auto [first, last] = reach_along(chart, x);
  show_span(plot->GetAxis(vtkAxis::BOTTOM), first, last, 0);
  show_span(plot->GetAxis(vtkAxis::LEFT), low, high, headroom);
  add(plot, curve("driven", x, y), 0);
  const std::vector<Chart::Level> levels = merged(chart.levels);
  for (std::size_t i = 0; i < levels.size(); ++i)
    add(plot, curve(levels[i].name, {x.front(), x.back()}, std::vector<Real>(2, unit.factor * levels[i].value)), i + 1);
  put_on_paper(plot, chart.out);
}

}  // namespace talus::render
