// A page that talus watch serves asks whether there is something new, and renews itself with its view kept.

const PLACE = 'talus: how far the page was scrolled';

/** Where the reader was in the page before it renewed itself. */
export function go_back() {
  const place = sessionStorage.getItem(PLACE);
  sessionStorage.removeItem(PLACE);
  if (place !== null) scrollTo({top: Number(place), behavior: 'instant'});
}

/** @param {{interval: number}} live s @param {() => void} keep the address says what is seen, from then on */
export function follow({interval}, keep) {
  const line = document.getElementById('live');
  line.hidden = false;
  line.textContent = `follows the run, asks every ${interval} s`;
  let known = null;
  const ask = async () => {
    try {
      const answer = await fetch('stamp', {cache: 'no-store'});
      if (!answer.ok) throw new Error(`answer ${answer.status}`);
      const stamp = await answer.text();
      if (known !== null && stamp !== known) {
        keep();
        sessionStorage.setItem(PLACE, scrollY);
        location.reload();
        return;
      }
      known = stamp;
      line.textContent = `follows the run, asks every ${interval} s`;
      line.classList.remove('lost');
    } catch {
      line.textContent = 'talus watch does not answer any more; the page shows the last that it told';
      line.classList.add('lost');
    }
    setTimeout(ask, 1000 * interval);
  };
  setTimeout(ask, 1000 * interval);
}
