// decode.js beside the page: a million particles must not stop the page from answering.
import {decode} from './decode.js';

self.onmessage = async ({data: {ticket, text, block}}) => {
  try {
    const numbers = await decode(text, block);
    self.postMessage({ticket, numbers}, [numbers.buffer]);
  } catch (error) {
    self.postMessage({ticket, error: error.message});
  }
};
