"""Files that become models: the model language and URDF. `read.read` chooses by the file's content."""
