// Blocks of this document, decoded beside the page where the browser allows a worker, else in it.
import {decode} from './decode.js';
import worker_source from 'worker:./decode_worker.js';

function start_worker() {
  try {
    return new Worker(URL.createObjectURL(new Blob([worker_source], {type: 'text/javascript'})));
  } catch {
    return null;
  }
}

/** @returns {{numbers: (block: import('./decode.js').Block) => Promise<ArrayLike<number>>}} */
export function make_blocks() {
  const waiting = new Map();
  let worker = start_worker();
  let last_ticket = 0;

  if (worker) {
    worker.onmessage = ({data: {ticket, numbers, error}}) => {
      const {keep, fail} = waiting.get(ticket);
      waiting.delete(ticket);
      if (error) fail(new Error(error));
      else keep(numbers);
    };
    worker.onerror = () => {
      // not allowed after all: what waits is done here
      worker = null;
      for (const {text, block, keep, fail} of waiting.values()) decode(text, block).then(keep, fail);
      waiting.clear();
    };
  }

  function numbers(block) {
    const element = document.getElementById(`block-${block.id}`);
    if (!element) return Promise.reject(new Error(`block ${block.id} is missing: the report is not whole`));
    const text = element.textContent;
    if (!worker) return decode(text, block);
    return new Promise((keep, fail) => {
      const ticket = ++last_ticket;
      waiting.set(ticket, {text, block, keep, fail});
      worker.postMessage({ticket, text, block});
    });
  }
  return {numbers};
}
