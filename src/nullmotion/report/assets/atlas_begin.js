// The first picture.
if (state.motion) goTo(whole()[data.begin_at_end ? 1 : 0], false);
else show();
repaint();
