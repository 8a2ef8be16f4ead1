"""What every layer uses and what knows none of them: files, JSON, resources, schemas, frames,
sentences in the reader's language."""
