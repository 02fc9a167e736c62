// A picture of a report. Usage: TALUS_PAGE_MODULES=build/release/page/node_modules node page/test/screenshot.mjs REPORT[#view] OUT.png [width height light|dark]
import {launch, open} from './browser.mjs';

const [report, out, width = '1600', height = '1000', scheme = 'light'] = process.argv.slice(2);
if (!out) {
  console.error('usage: node screenshot.mjs REPORT[#view] OUT.png [width height light|dark]');
  process.exit(2);
}
const browser = await launch();
const {page, complaints} = await open(browser, report, {width: Number(width), height: Number(height), scheme});
await page.waitForTimeout(500);
await page.screenshot({path: out});
await browser.close();
if (complaints.length) {
  console.error(complaints.join('\n'));
  process.exit(1);
}
